// Words of a line in which a number is followed by its unit, by relations and not by intervals: WP proves that nothing
// behind a word is read. link_ranges.h says what is taken of the functions that look at them.

#include "firmware/console/commands_drive.c"
#include "firmware/console/commands_parameters.c"
#include "firmware/console/words_of_line.c"
#include "firmware/dictionary/parameters.h"

/*@ predicate word_of(word_t* w) = \valid_read(w) && 1 <= w->count <= EDITOR_LINE &&
      \valid_read(w->text + (0 .. w->count - 1));

    predicate behind(word_t* w, word_t* next) = \base_addr(w->text) == \base_addr(next->text) &&
      w->text + w->count <= next->text <= w->text + EDITOR_LINE;

    predicate words_of(words_of_line_t* a) = \valid_read(a) && a->count <= COMMAND_WORDS &&
      (a->count > 0 ==> word_of(&a->word[0])) && (a->count > 1 ==> word_of(&a->word[1])) &&
      (a->count > 2 ==> word_of(&a->word[2])) && (a->count > 1 ==> behind(&a->word[0], &a->word[1])) &&
      (a->count > 2 ==> behind(&a->word[1], &a->word[2]));
*/

/*@ requires \valid_read(a) && a->count <= COMMAND_WORDS && (k < a->count ==> word_of(&a->word[k]));
    requires unit < PACKED_TEXTS; assigns \nothing; */
bool word_is(const words_of_line_t* a, uint16_t k, packed_text_t unit);

/*@ requires words_of(a) && k < a->count; assigns \nothing; */
word_t words_from(const words_of_line_t* a, uint16_t k);

/*@ requires words_of(a) && k < a->count && word_of(&a->word[k]) && (k + 1 < a->count ==> word_of(&a->word[k + 1]));
    requires unit < PACKED_TEXTS && \valid(number) && \separated(number, a);
    assigns *number; ensures \result <= a->word[k].count; ensures number->decimals <= 9; */
uint16_t number_with_unit(const words_of_line_t* a, uint16_t k, packed_text_t unit, decimal_t* number);

// What the table says, the part commands reads.
/*@ requires \valid_read(name + (0 .. count - 1)); assigns \nothing;
    ensures \result == \null || (\valid_read(\result) && \result->q <= 32); */
const parameter_info_t* parameter_named(const uint16_t* name, uint16_t count);

/*@ assigns \nothing; ensures \result <= 40; */
uint16_t parameter_q(const parameter_info_t* p);

/*@ assigns \nothing; ensures \result < PACKED_TEXTS; */
packed_text_t parameter_unit(const parameter_info_t* p);

/*@ requires words_of(a); */
void command_set(const words_of_line_t* a);

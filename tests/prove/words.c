// Words of a line in which a number is followed by its unit, by relations and not by intervals: WP proves that nothing
// behind a word is read. link_ranges.h says what is taken of the functions that look at them.

#include "firmware/console/commands_drive.c"
#include "firmware/console/commands_parameters.c"
#include "firmware/dictionary/parameters.h"

/*@ predicate word_of(word_t* w) = \valid_read(w) && 1 <= w->count <= EDITOR_LINE &&
      \valid_read(w->text + (0 .. w->count - 1));

    predicate words_of(words_of_line_t* a) = \valid_read(a) && a->count <= COMMAND_WORDS &&
      (a->count > 0 ==> word_of(&a->word[0])) && (a->count > 1 ==> word_of(&a->word[1])) &&
      (a->count > 2 ==> word_of(&a->word[2]));
*/

/*@ requires words_of(a) && unit < PACKED_TEXTS; assigns \nothing; */
bool word_is(const words_of_line_t* a, uint16_t k, packed_text_t unit);

/*@ requires words_of(a) && a->count >= 1 && \valid(number) && \separated(number, a); assigns *number;
    ensures \result <= a->word[0].count; */
static uint16_t read_speed(const words_of_line_t* a, decimal_t* number);

/*@ requires words_of(a) && a->count >= 2 && number_length <= a->word[1].count && unit < PACKED_TEXTS;
    assigns \nothing; */
static bool unit_fits(const words_of_line_t* a, uint16_t number_length, packed_text_t unit);

// What the table says, the part commands reads.
/*@ requires \valid_read(name + (0 .. count - 1)); assigns \nothing;
    ensures \result == \null || (\valid_read(\result) && \result->q <= 32); */
const parameter_info_t* parameter_named(const uint16_t* name, uint16_t count);

/*@ assigns \nothing; ensures \result < PACKED_TEXTS; */
packed_text_t parameter_unit(const parameter_info_t* p);

/*@ requires words_of(a); */
void command_set(const words_of_line_t* a);

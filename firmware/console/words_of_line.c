#include "firmware/console/words_of_line.h"

#include <stddef.h>

bool word_is(const words_of_line_t* a, uint16_t k, packed_text_t text) {
  return k < a->count && packed_equals(text, a->word[k].text, a->word[k].count);
}

word_t words_from(const words_of_line_t* a, uint16_t k) {
  const word_t* const last = &a->word[a->count - 1u];
  word_t all = a->word[k];
  all.count = (uint16_t)(&last->text[last->count] - all.text);
  return all;
}

uint16_t number_with_unit(const words_of_line_t* a, uint16_t k, packed_text_t unit, decimal_t* number) {
  const word_t* const value = &a->word[k];
  const uint16_t behind = (uint16_t)(a->count - k - 1u);
  const uint16_t length = text_number(value->text, value->count, number);
  const uint16_t left = (uint16_t)(value->count - length);
  if (left > 0u && (behind > 0u || !packed_equals(unit, &value->text[length], left))) return 0;
  return (behind == 0u || (behind == 1u && word_is(a, (uint16_t)(k + 1u), unit))) ? length : 0u;
}

void put_word(octet_writer_t* w, const word_t* word) {
  for (uint16_t k = 0; k < word->count; k++) put_u8(w, word->text[k]);
}

static word_t wanted;

void filter_begin(const words_of_line_t* a) {
  static const word_t nothing = {NULL, 0};
  wanted = (a->count > 0u) ? a->word[0] : nothing;
}

bool filter_takes(packed_text_t name, packed_text_t meaning) {
  return wanted.text == NULL || packed_occurs(name, wanted.text, wanted.count) ||
         packed_occurs(meaning, wanted.text, wanted.count);
}

word_t next_word(const editor_line_t* line, uint16_t* at) {
  while (*at < line->count && line->text[*at] == ' ') (*at)++;
  word_t word = {&line->text[*at], 0};
  while (*at < line->count && line->text[*at] != ' ') {
    (*at)++;
    word.count++;
  }
  return word;
}

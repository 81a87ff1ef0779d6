#include "firmware/console/words_of_line.h"

#include <stddef.h>

bool word_is(const words_of_line_t* a, uint16_t k, packed_text_t text) {
  return k < a->count && packed_equals(text, a->word[k].text, a->word[k].count);
}

void put_word(octet_writer_t* w, const word_t* word) {
  for (uint16_t k = 0; k < word->count; k++) put_u8(w, word->text[k]);
}

bool word_occurs(const word_t* word, packed_text_t text) {
  return word->text == NULL || packed_occurs(text, word->text, word->count);
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

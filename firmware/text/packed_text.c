#include "firmware/text/packed_text.h"

#include "firmware/text/text.h"

#define END 0u      // first code: a text ends, a word ends
#define SPELLED 1u  // second code of an entry: a word's letters follow in the text
#define GLUED 2u    // first letter of a word's ending: without a joint

enum { NO_WORD, OF_DICTIONARY, OF_TEXT };

// What the next bits stand for, in a canonical Huffman code of which so many codes have one bit, two bits, ... 16 bits.
static uint16_t next_code(uint32_t* at, const uint16_t* counts) {
  const uint16_t* const words = &packed_bits[(uint16_t)(*at >> 4)];
  uint32_t bits = ((uint32_t)words[0] << 16 | words[1]) << ((uint16_t)*at & 15u);
  uint16_t shorter = 0;
  for (uint16_t code = 0;; counts++) {
    code = (uint16_t)(2u * code + (uint16_t)(bits >> 31));
    bits <<= 1;
    (*at)++;
    if (code < *counts) return (uint16_t)(shorter + code);
    code = (uint16_t)(code - *counts);
    shorter = (uint16_t)(shorter + *counts);
  }
}

static void skip_word(uint32_t* at) {
  while (next_code(at, packed_letter_counts) != END) continue;
}

static void skip_text(uint32_t* at) {
  uint16_t entry;
  do {
    entry = next_code(at, packed_entry_counts);
    if (entry == SPELLED) skip_word(at);
  } while (entry != END);
}

packed_reader_t packed_reader(packed_text_t text) {
  packed_reader_t r = {(uint32_t)packed_starts[text / PACKED_BLOCK] << 4, 0, NO_WORD, 0, 0, ' '};
  if (text >= (packed_text_t)PACKED_FIRST_NAME) r.joint = '_';
  for (uint16_t k = text % PACKED_BLOCK; k > 0u; k--) skip_text(&r.text);
  return r;
}

// Of two in a word.
static uint16_t octet_at(const uint16_t* words, uint16_t k) { return (words[k / 2u] >> 8u * (k % 2u)) & 0xFFu; }

// 0 at the end of a word.
static uint16_t next_letter(packed_reader_t* r) {
  return octet_at(packed_letters, next_code((r->word_is == OF_TEXT) ? &r->text : &r->word, packed_letter_counts));
}

// The next word's first letter, 0 at the end.
static uint16_t begin_word(packed_reader_t* r) {
  const uint16_t entry = next_code(&r->text, packed_entry_counts);
  if (entry == END) return 0;
  r->word_is = (entry == SPELLED) ? OF_TEXT : OF_DICTIONARY;
  r->word = (uint32_t)packed_dictionary[entry / PACKED_BLOCK] << 4;
  for (uint16_t k = entry % PACKED_BLOCK; k > 0u; k--) skip_word(&r->word);
  return next_letter(r);
}

// A letter or a digit.
static bool is_of_word(uint16_t c) {
  return (text_small(c) >= (uint16_t)'a' && text_small(c) <= (uint16_t)'z') || (c >= '0' && c <= '9');
}

uint16_t packed_next(packed_reader_t* r) {
  uint16_t c = r->held;
  r->held = 0;
  if (c == 0u && r->word_is != NO_WORD) c = next_letter(r);
  if (c == 0u) {
    c = begin_word(r);
    if (c == GLUED) {
      c = next_letter(r);
    } else if (is_of_word(c) && is_of_word(r->last)) {
      r->held = c;
      c = r->joint;
    }
  }
  r->last = c;
  return c;
}

void put_packed(octet_writer_t* w, packed_text_t text) {
  packed_reader_t r = packed_reader(text);
  uint16_t c = packed_next(&r);
  while (c != 0u && !w->full) {
    put_u8(w, c);
    c = packed_next(&r);
  }
}

void put_label(octet_writer_t* w, packed_text_t text) {
  put_packed(w, text);
  put_u8(w, ' ');
}

void put_count(octet_writer_t* w, uint32_t count, packed_text_t what) {
  put_unsigned(w, count);
  put_packed(w, what);
}

bool packed_is_empty(packed_text_t text) {
  packed_reader_t r = packed_reader(text);
  return packed_next(&r) == 0u;
}

// Whether the text goes on with these characters.
static bool goes_on_with(packed_reader_t* r, const uint16_t* wanted, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) {
    const uint16_t c = packed_next(r);
    if (c == 0u || text_small(c) != text_small(wanted[k])) return false;
  }
  return true;
}

bool packed_rest_is(const packed_reader_t* from, const uint16_t* wanted, uint16_t count) {
  packed_reader_t r = *from;
  return goes_on_with(&r, wanted, count) && packed_next(&r) == 0u;
}

bool packed_equals(packed_text_t text, const uint16_t* wanted, uint16_t count) {
  const packed_reader_t r = packed_reader(text);
  return packed_rest_is(&r, wanted, count);
}

uint16_t packed_find(packed_text_t first, uint16_t texts, const uint16_t* wanted, uint16_t count) {
  const uint16_t place = (uint16_t)(first - (uint16_t)PACKED_FIRST_NAME);
  uint16_t key = 0;
  for (uint16_t k = 0; k < count; k++) key = (31u * key + text_small(wanted[k])) & 0xFFu;
  key = (key ^ key >> 4) & 0xFu;
  for (uint16_t at = 0; at < texts; at++) {
    const uint16_t k = (uint16_t)(place + at);
    if ((packed_keys[k / 4u] >> 4u * (k % 4u) & 0xFu) != key) continue;
    if (packed_equals((packed_text_t)(first + at), wanted, count)) return at;
  }
  return texts;
}

bool packed_occurs(packed_text_t text, const uint16_t* wanted, uint16_t count) {
  packed_reader_t r = packed_reader(text);
  if (count == 0u) return true;
  do {
    packed_reader_t here = r;
    if (goes_on_with(&here, wanted, count)) return true;
  } while (packed_next(&r) != 0u);
  return false;
}

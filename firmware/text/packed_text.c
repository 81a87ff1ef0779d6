#include "firmware/text/packed_text.h"

#include "firmware/text/text.h"

#define FIRST_PAIR 128u

packed_reader_t packed_reader(packed_text_t text) {
  packed_reader_t r;
  r.at = packed_starts[text];
  r.depth = 0;
  return r;
}

uint16_t packed_next(packed_reader_t* r) {
  uint16_t code;
  if (r->depth > 0u) {
    code = r->waiting[--r->depth];
  } else {
    const uint16_t word = packed_octets[r->at >> 1];
    code = ((r->at & 1u) != 0u) ? (uint16_t)(word >> 8) : (uint16_t)(word & 0xFFu);
    r->at++;
  }
  while (code >= FIRST_PAIR) {
    const uint16_t pair = packed_pairs[code - FIRST_PAIR];
    r->waiting[r->depth++] = (uint16_t)(pair & 0xFFu);
    code = (uint16_t)(pair >> 8);
  }
  return code;
}

void put_packed(octet_writer_t* w, packed_text_t text) {
  packed_reader_t r = packed_reader(text);
  uint16_t c = packed_next(&r);
  while (c != 0u && !w->full) {
    put_u8(w, c);
    c = packed_next(&r);
  }
}

bool packed_is_empty(packed_text_t text) {
  packed_reader_t r = packed_reader(text);
  return packed_next(&r) == 0u;
}

void packed_copy(packed_text_t text, char* string, uint16_t room) {
  packed_reader_t r = packed_reader(text);
  uint16_t k = 0;
  for (uint16_t c = packed_next(&r); c != 0u && k + 1u < room; c = packed_next(&r)) string[k++] = (char)c;
  string[k] = '\0';
}

bool packed_is(packed_text_t text, const char* string) {
  packed_reader_t r = packed_reader(text);
  uint16_t c = packed_next(&r);
  for (; c != 0u && c == (uint16_t)*string; string++) c = packed_next(&r);
  return c == 0u && *string == '\0';
}

bool packed_equals(packed_text_t text, const uint16_t* wanted, uint16_t count) {
  packed_reader_t r = packed_reader(text);
  uint16_t c = packed_next(&r);
  uint16_t k = 0;
  for (; c != 0u && k < count && text_small(c) == text_small(wanted[k]); k++) c = packed_next(&r);
  return c == 0u && k == count;
}

// Whether the text goes on with these characters.
static bool goes_on_with(packed_reader_t r, const uint16_t* wanted, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) {
    const uint16_t c = packed_next(&r);
    if (c == 0u || text_small(c) != text_small(wanted[k])) return false;
  }
  return true;
}

bool packed_occurs(packed_text_t text, const uint16_t* wanted, uint16_t count) {
  packed_reader_t r = packed_reader(text);
  if (count == 0u) return true;
  do {
    if (goes_on_with(r, wanted, count)) return true;
  } while (packed_next(&r) != 0u);
  return false;
}

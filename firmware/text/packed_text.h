// The drive's texts, packed in flash: two octets in a word, an octet above 127 stands for two others.
//
// A character of a string takes a whole word of the C28x's memory. toolchain/pack_text.py takes the texts from the
// lists that people edit, numbers them (text_numbers.h, made by the build) and packs them to less than a third (byte
// pair encoding: P. Gage, "A New Algorithm for Data Compression", C Users Journal 12(2), 1994).

#ifndef STILLSPIN_FIRMWARE_TEXT_PACKED_TEXT_H
#define STILLSPIN_FIRMWARE_TEXT_PACKED_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"
#include "firmware/text/text_numbers.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// A text's number. Texts that are the same share their octets.
typedef uint16_t packed_text_t;

#define PACKED_NONE PACKED_TEXTS  // no text

#define PACKED_DEPTH 8u  // pairs of pairs, at most so deep

/// A place in a text.
typedef struct {
  uint16_t at;                     // octet
  uint16_t waiting[PACKED_DEPTH];  // second halves of the pairs begun
  uint16_t depth;
} packed_reader_t;

packed_reader_t packed_reader(packed_text_t text);

/// The next character, 0 at the end and from there on nothing of sense.
uint16_t packed_next(packed_reader_t* r);

/// Writes a text out.
void put_packed(octet_writer_t* w, packed_text_t text);

bool packed_is_empty(packed_text_t text);

/// The text as a string; what is beyond `room` characters, its end among them, is left out. room > 0.
void packed_copy(packed_text_t text, char* string, uint16_t room);

/// True when the text is that string.
bool packed_is(packed_text_t text, const char* string);

/// True when the text is these characters and no more; capitals count as small letters.
bool packed_equals(packed_text_t text, const uint16_t* wanted, uint16_t count);

/// True when these characters occur in the text; capitals count as small letters.
bool packed_occurs(packed_text_t text, const uint16_t* wanted, uint16_t count);

// What pack_text.py makes: where each text begins (octets), what the octets from 128 on stand for (first, second), and
// the octets, the first in the lower half of a word. A zero ends a text.
extern const uint16_t packed_starts[];
extern const uint16_t packed_pairs[];
extern const uint16_t packed_octets[];

#if defined(__cplusplus)
}
#endif

#endif

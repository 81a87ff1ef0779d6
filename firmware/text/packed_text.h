// The drive's texts, packed in flash: two octets in a word, an octet above 127 stands for two others.
//
// A character of a string takes a whole word of the C28x's memory. toolchain/pack_text.py takes the texts from the
// lists below, in this order, and packs them to less than a third (byte pair encoding: P. Gage, "A New Algorithm for
// Data Compression", C Users Journal 12(2), 1994).

#ifndef STILLSPIN_FIRMWARE_TEXT_PACKED_TEXT_H
#define STILLSPIN_FIRMWARE_TEXT_PACKED_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// A text's number. Texts that are the same share their octets.
typedef uint16_t packed_text_t;

/// The texts, by the list that they stand in.
enum {
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) TEXT_PARAMETER_##name,
#include "firmware/dictionary/parameter_list.h"
#undef PARAMETER
#define SIGNAL(name, unit, q, of, value, meaning) TEXT_SIGNAL_##name,
#include "firmware/dictionary/signal_list.h"
#undef SIGNAL
#define FAULT(number, name, words, remedy) TEXT_FAULT_##number,
#include "firmware/dictionary/fault_list.h"
#undef FAULT
#define FAULT(number, name, words, remedy) TEXT_REMEDY_##number,
#include "firmware/dictionary/fault_list.h"
#undef FAULT
#define WORDS(kind, code, text) TEXT_##kind##_##code,
#include "firmware/text/word_list.h"
#undef WORDS
#define COMMAND(name, arguments, help) TEXT_COMMAND_##name,
#include "firmware/console/command_list.h"
#undef COMMAND
#define HELP(command, number, text) TEXT_HELP_##command##_##number,
#include "firmware/console/help_list.h"
#undef HELP
#define PHRASE(name, text) SAY_##name,
#include "firmware/text/phrase_list.h"
#undef PHRASE
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) TEXT_PARAMETER_NAME_##name,
#include "firmware/dictionary/parameter_list.h"
#undef PARAMETER
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) TEXT_PARAMETER_UNIT_##name,
#include "firmware/dictionary/parameter_list.h"
#undef PARAMETER
#define SIGNAL(name, unit, q, of, value, meaning) TEXT_SIGNAL_NAME_##name,
#include "firmware/dictionary/signal_list.h"
#undef SIGNAL
#define SIGNAL(name, unit, q, of, value, meaning) TEXT_SIGNAL_UNIT_##name,
#include "firmware/dictionary/signal_list.h"
#undef SIGNAL
#define COMMAND(name, arguments, help) TEXT_COMMAND_NAME_##name,
#include "firmware/console/command_list.h"
#undef COMMAND
#define COMMAND(name, arguments, help) TEXT_COMMAND_ARGUMENTS_##name,
#include "firmware/console/command_list.h"
#undef COMMAND
  PACKED_TEXTS
};

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

// The drive's texts, packed in flash: Huffman codes of the words of a dictionary, whose letters are coded as well.
//
// A character of a string takes a whole word of the C28x's memory. toolchain/pack_text.py takes the texts from the
// lists that people edit, numbers them (text_numbers.h, made by the build) and packs them to a fifth
// (toolchain/word_code.py). Where two words or numbers follow each other a space is between them, in a name an
// underscore; an ending that many words share follows its stem. A word that is said once is in no dictionary: its
// letters are in the text.

#ifndef STILLSPIN_FIRMWARE_TEXT_PACKED_TEXT_H
#define STILLSPIN_FIRMWARE_TEXT_PACKED_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"
#include "firmware/text/text_numbers.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// A text's number.
typedef uint16_t packed_text_t;

#define PACKED_NONE PACKED_TEXTS  // no text

#define PACKED_BLOCK 32u  // so many texts, or entries of the dictionary, are read to find one

/// A place in a text.
typedef struct {
  uint32_t text;  // bits
  uint32_t word;  // the same, in the dictionary
  uint16_t word_is;
  uint16_t last;   // character
  uint16_t held;   // a word's first letter, for which the joint came
  uint16_t joint;  // between two words
} packed_reader_t;

packed_reader_t packed_reader(packed_text_t text);

/// The next character, 0 at the end and from there on nothing of sense.
uint16_t packed_next(packed_reader_t* r);

/// Writes a text out.
void put_packed(octet_writer_t* w, packed_text_t text);

/// The same with a space behind it.
void put_label(octet_writer_t* w, packed_text_t text);

/// A number, and the text behind it.
void put_count(octet_writer_t* w, uint32_t count, packed_text_t what);

bool packed_is_empty(packed_text_t text);

/// True when from here to the text's end it is these characters and no more; capitals count as small letters.
bool packed_rest_is(const packed_reader_t* from, const uint16_t* wanted, uint16_t count);

/// True when the text is these characters and no more; capitals count as small letters.
bool packed_equals(packed_text_t text, const uint16_t* wanted, uint16_t count);

/// Which of so many names, from `first` on, it is: these characters and no more, and capitals count as small letters;
/// `texts` when it is none. A name is found by its key, which leaves one of sixteen others to be read.
uint16_t packed_find(packed_text_t first, uint16_t texts, const uint16_t* wanted, uint16_t count);

/// True when these characters occur in the text; capitals count as small letters.
bool packed_occurs(packed_text_t text, const uint16_t* wanted, uint16_t count);

// What pack_text.py makes: the word of packed_bits at which every 32nd text begins, and every 32nd entry of
// the dictionary, which are in the order of their codes; how many codes have one bit, two bits and so on; the letters
// in the order of theirs, two in a word, and the keys of the names (packed_find), four in a word.
extern const uint16_t packed_starts[];
extern const uint16_t packed_dictionary[];
extern const uint16_t packed_entry_counts[];
extern const uint16_t packed_letter_counts[];
extern const uint16_t packed_letters[];
extern const uint16_t packed_keys[];
extern const uint16_t packed_bits[];

#if defined(__cplusplus)
}
#endif

#endif

// A command line as words.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_WORDS_OF_LINE_H
#define STILLSPIN_FIRMWARE_CONSOLE_WORDS_OF_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"
#include "firmware/console/editor.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// A word of the command line; it stays where it is until the command's job is through.
typedef struct {
  const uint16_t* text;
  uint16_t count;
} word_t;

#define COMMAND_WORDS 16u

typedef struct {
  uint16_t count;
  bool expired;                // it stood for long before its end came
  word_t word[COMMAND_WORDS];  // behind the command's own; more than any command takes
} words_of_line_t;

/// The word from `at` on, or the next one; moves `at` behind it.
word_t next_word(const editor_line_t* line, uint16_t* at);

/// All that was typed from word k on, which is there.
word_t words_from(const words_of_line_t* a, uint16_t k);

/// "600 rpm", "600rpm" or "600" from word k, which is there, to the end of the line: how long the number is, 0 for all
/// else.
uint16_t number_with_unit(const words_of_line_t* a, uint16_t k, packed_text_t unit, decimal_t* number);

/// The word as it was typed.
void put_word(octet_writer_t* w, const word_t* word);

/// True when word k is there and is this text.
bool word_is(const words_of_line_t* a, uint16_t k, packed_text_t text);

/// What a list is to show: rows in whose name or meaning the line's first word occurs, all where it has none.
void filter_begin(const words_of_line_t* a);
bool filter_takes(packed_text_t name, packed_text_t meaning);

#if defined(__cplusplus)
}
#endif

#endif

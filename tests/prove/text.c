// Numbers and words in and out of text: every text of the drive's tables, any characters that somebody typed, any value
// in any format.

#include "firmware/text/text.h"

#include "firmware/console/suggest/suggest.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/text/catalogue.h"
#include "tests/prove/any_parameters.h"

#define WORDS_OF_A_KIND 48  // at least; what comes behind is there for no kind

static uint16_t block[240];
static uint16_t typed[EDITOR_LINE];
static word_t word;

static octet_writer_t writer(void) { return octet_writer(block, 240); }

static void any_word(void) {
  for (uint16_t k = 0; k < EDITOR_LINE; k++) typed[k] = any_u16 & 0x7Fu;
  word.text = typed;
  word.count = (uint16_t)any_from(0, (int32_t)EDITOR_LINE);
}

// Whatever was typed, compared with one text.
static void compare_packed(packed_text_t text) {
  octet_writer_t w = writer();
  put_packed(&w, text);
  word.count = (uint16_t)any_from(0, (int32_t)EDITOR_LINE);
  (void)packed_equals(text, word.text, word.count);
  (void)packed_occurs(text, word.text, word.count);
}

void prove_names(void) {
  any_word();
  compare_packed((packed_text_t)any_from(0, (int32_t)PACKED_TEXTS - 1));
}

void prove_near(void) {
  any_word();
  for (word.count = 0; word.count <= EDITOR_LINE; word.count++) {
    (void)suggest_is_near((packed_text_t)any_from(0, (int32_t)PACKED_TEXTS - 1), &word);
  }
}

static void one_format(uint16_t q, uint16_t decimals) {
  octet_writer_t w = writer();
  const decimal_t number = {any_from(-INT32_MAX, INT32_MAX), decimals};
  put_fixed(&w, any_i32, q, decimals);
  int32_t raw;
  (void)decimal_raw(&number, q, &raw);
  (void)decimal_is_whole(&number);
}

static void words_of(uint16_t kind) {
  octet_writer_t w = writer();
  for (uint16_t code = 0; code < WORDS_OF_A_KIND; code++) put_message(&w, (catalogue_t)kind, code);
  put_message(&w, (catalogue_t)kind, (uint16_t)any_from(WORDS_OF_A_KIND, 65535L));
}

// One more octet, however full the block is; all else goes through this.
static void one_octet(void) {
  octet_writer_t w = octet_writer(block, 240);
  w.count = (uint16_t)any_from(0, 240);
  w.full = any_bool();
  put_u8(&w, any_u16);
  //@ assert w.count <= w.room;
}

void prove_numbers(void) {
  decimal_t number;
  one_octet();
  octet_writer_t w = writer();
  put_unsigned(&w, any_u32);
  put_spaces_to(&w, any_u16);
  any_word();
  for (uint16_t count = 0; count <= EDITOR_LINE; count++) (void)text_number(word.text, count, &number);
  for (uint16_t kind = 0; kind < CATALOGUES; kind++) words_of(kind);
  any_parameters();
  for (uint16_t unit = 0; unit < (uint16_t)UNITS; unit++) (void)unit_exponent(unit);
  for (uint16_t q = 0; q <= 40u; q++) {
    for (uint16_t decimals = 0; decimals <= TEXT_DECIMALS_MAX; decimals++) one_format(q, decimals);
  }
}

// Every text, to its end. The first are the long ones.
static void read_from(uint16_t first, uint16_t end) {
  for (uint16_t text = first; text < end; text++) {
    packed_reader_t r = packed_reader((packed_text_t)text);
    while (packed_next(&r) != 0u) continue;
  }
}

#define MIDDLE (PACKED_TEXTS * 3u / 8u)
#define BEHIND (PACKED_TEXTS * 5u / 8u)

void prove_packed_before(void) { read_from(0, MIDDLE); }

void prove_packed_middle(void) { read_from(MIDDLE, BEHIND); }

void prove_packed_behind(void) { read_from(BEHIND, PACKED_TEXTS); }

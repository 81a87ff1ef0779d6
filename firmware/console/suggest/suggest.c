#include "firmware/console/suggest.h"

#include <stddef.h>

#include "firmware/base/edition.h"
#include "firmware/console/command_table.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#define NAMES_A_STEP 4u
#define MOST 4u
#define SHORTEST_PART 2u

static suggest_kind_t kind_of;
static word_t wanted;
static packed_text_t near[MOST];
static uint16_t found;

// Whether another edition of the firmware has it.
static bool is_left_out(void) {
  if (kind_of == SUGGEST_COMMAND) return command_find(&wanted) < COMMANDS;
  if (parameter_name_is_left_out(wanted.text, wanted.count)) return true;
  return signal_is_left_out(signal_named(wanted.text, wanted.count));
}

// PACKED_NONE behind the last one.
static packed_text_t name_of(uint16_t index) {
  if (kind_of == SUGGEST_COMMAND) return command_name(index);
  if (kind_of == SUGGEST_SIGNAL) {
    const signal_info_t* const s = signal_info(index);
    return (s != NULL) ? s->name : PACKED_NONE;
  }
  const parameter_info_t* const p = parameter_info(index);
  return (p != NULL) ? parameter_name(p) : PACKED_NONE;
}

static uint16_t length(const char* name) {
  uint16_t n = 0;
  while (name[n] != '\0') n++;
  return n;
}

// What follows the first difference, with one character of the longer one left out, or one of each, or two exchanged.
static bool is_one_edit_away(const char* name, const word_t* word) {
  const uint16_t n = length(name);
  const uint16_t m = word->count;
  uint16_t k = 0;
  while (k < n && k < m && text_begins(&name[k], &word->text[k], 1)) k++;
  const uint16_t* const rest = &word->text[k];
  const uint16_t left = (uint16_t)(m - k);
  if (n == m + 1u) return text_equals(&name[k + 1u], rest, left);
  if (m == n + 1u) return text_equals(&name[k], rest + 1, (uint16_t)(left - 1u));
  if (m != n) return false;
  if (left < 2u) return left == 1u;
  if (text_equals(&name[k + 1u], rest + 1, (uint16_t)(left - 1u))) return true;
  return text_begins(&name[k], rest + 1, 1) && text_begins(&name[k + 1u], rest, 1) &&
         text_equals(&name[k + 2u], rest + 2, (uint16_t)(left - 2u));
}

bool suggest_is_near(const char* name, const word_t* word) {
  const uint16_t n = length(name);
  const bool begins_it = n >= SHORTEST_PART && n < word->count && text_begins(name, word->text, n);
  const bool contains_it = word->count >= SHORTEST_PART && text_occurs(name, word->text, word->count);
  return begins_it || contains_it || is_one_edit_away(name, word);
}

static void say(void) {
  octet_writer_t* const w = line_begin();
  put_packed(w, (packed_text_t)(SAY_there_is_no_command + (uint16_t)kind_of));
  put_word(w, &wanted);
  put_u8(w, '\'');
  for (uint16_t k = 0; k < found; k++) {
    if (k == 0u) {
      put_packed(w, SAY_did_you_mean);
    } else {
      put_packed(w, SAY_comma);
    }
    put_packed(w, near[k]);
  }
  if (found > 0u) {
    put_u8(w, '?');
  } else if (kind_of == SUGGEST_COMMAND) {
    put_packed(w, SAY_see_help);
  }
  line_end_refused();
}

// Parameters count those of the edition alone.
static bool is_here(uint16_t index) {
  if (kind_of == SUGGEST_COMMAND) return command_is_here(index);
  return kind_of != SUGGEST_SIGNAL || !signal_is_left_out(index);
}

static bool look(uint16_t step) {
  for (uint16_t k = 0; k < NAMES_A_STEP; k++) {
    const packed_text_t number = name_of((uint16_t)(step * NAMES_A_STEP + k));
    if (number == PACKED_NONE || found == MOST) {
      say();
      return false;
    }
    char name[SUGGEST_NAME_ROOM];
    packed_copy(number, name, SUGGEST_NAME_ROOM);
    if (is_here((uint16_t)(step * NAMES_A_STEP + k)) && suggest_is_near(name, &wanted)) near[found++] = number;
  }
  return true;
}

static void refuse_left_out(void) {
  octet_writer_t* const w = line_begin();
  put_u8(w, '\'');
  put_word(w, &wanted);
  put_packed(w, SAY_is_not_in_this_edition);
  put_text(w, edition_name);
  put_packed(w, SAY_see_editions_in_the_book);
  line_end_refused();
}

void suggest(suggest_kind_t kind, const word_t* word) {
  kind_of = kind;
  wanted = *word;
  found = 0;
  if (is_left_out()) {
    refuse_left_out();
    return;
  }
  console_run(look, false);
}

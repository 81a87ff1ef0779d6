#include "firmware/console/commands.h"

#include <stddef.h>

#include "firmware/console/console.h"
#include "firmware/console/output.h"
#include "firmware/console/suggest.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#define COMMAND(name, arguments, help) command_##name,
command_function_t* const commands[] = {
#include "firmware/console/command_list.h"
};
#undef COMMAND

#define COMMANDS ((uint16_t)(sizeof commands / sizeof commands[0]))

// The texts stand in the table's order.
static packed_text_t text_of(packed_text_t first, uint16_t command) { return (packed_text_t)(first + command); }

packed_text_t command_name(uint16_t command) {
  return (command < COMMANDS) ? text_of(TEXT_COMMAND_NAME_help, command) : PACKED_NONE;
}

// COMMANDS when there is none of that name.
static uint16_t find(const word_t* word) {
  uint16_t k = 0;
  while (k < COMMANDS && !packed_equals(command_name(k), word->text, word->count)) k++;
  return k;
}

bool word_is(const words_of_line_t* a, uint16_t k, const char* name) {
  return k < a->count && text_equals(name, a->word[k].text, a->word[k].count);
}

bool word_is_packed(const words_of_line_t* a, uint16_t k, packed_text_t text) {
  return k < a->count && packed_equals(text, a->word[k].text, a->word[k].count);
}

void put_word(octet_writer_t* w, const word_t* word) {
  for (uint16_t k = 0; k < word->count; k++) put_u8(w, word->text[k]);
}

bool word_occurs(const word_t* word, packed_text_t text) {
  return word->text == NULL || packed_occurs(text, word->text, word->count);
}

// The word from `at` on, or the next one; moves `at` behind it.
static word_t next_word(const editor_line_t* line, uint16_t* at) {
  while (*at < line->count && line->text[*at] == ' ') (*at)++;
  word_t word = {&line->text[*at], 0};
  while (*at < line->count && line->text[*at] != ' ') {
    (*at)++;
    word.count++;
  }
  return word;
}

void command_obey(const editor_line_t* line, bool expired) {
  uint16_t at = 0;
  const word_t name = next_word(line, &at);
  if (name.count == 0u) return;
  const uint16_t command = find(&name);
  if (command == COMMANDS) {
    suggest(SUGGEST_COMMAND, &name);
    return;
  }
  words_of_line_t a;
  a.expired = expired;
  for (a.count = 0; a.count < COMMAND_WORDS; a.count++) {
    a.word[a.count] = next_word(line, &at);
    if (a.word[a.count].count == 0u) break;
  }
  commands[command](&a);
}

bool command_may_move(const words_of_line_t* a) {
  if (a->expired) line_refused(SAY_the_line_is_too_old_to_move);
  return !a->expired;
}

bool command_makes_safe(const editor_line_t* line) {
  uint16_t at = 0;
  const word_t name = next_word(line, &at);
  return text_equals("stop", name.text, name.count) || text_equals("coast", name.text, name.count);
}

static void put_command(uint16_t command) {
  octet_writer_t* const w = line_begin();
  put_packed(w, command_name(command));
  put_u8(w, ' ');
  put_packed(w, text_of(TEXT_COMMAND_ARGUMENTS_help, command));
  put_spaces_to(w, 26);
  put_packed(w, text_of(TEXT_COMMAND_help, command));
  line_end();
}

static bool list_commands(uint16_t step) {
  if (step < COMMANDS) put_command(step);
  if (step == COMMANDS) line_of(SAY_ctrl_c_ends_a_long_answer_stop);
  return step < COMMANDS;
}

// The command that each line of help_list.h is about.
#define HELP(command, number, text) TEXT_COMMAND_##command,
static const packed_text_t explains[] = {
#include "firmware/console/help_list.h"
};
#undef HELP

static uint16_t explained;  // command

static bool explain(uint16_t step) {
  if (step == 0u) {
    put_command(explained);
    return true;
  }
  const uint16_t at = (uint16_t)(step - 1u);
  if (at >= sizeof explains / sizeof explains[0]) return false;
  if (explains[at] != text_of(TEXT_COMMAND_help, explained)) return true;
  put_packed(line_begin(), (packed_text_t)(TEXT_HELP_list_1 + at));
  line_end();
  return true;
}

void command_help(const words_of_line_t* a) {
  if (a->count == 0u) {
    console_run(list_commands, false);
    return;
  }
  const uint16_t command = find(&a->word[0]);
  if (command < COMMANDS) {
    explained = command;
    console_run(explain, false);
  } else {
    suggest(SUGGEST_COMMAND, &a->word[0]);
  }
}

#include "firmware/console/commands.h"

#include "firmware/base/edition.h"
#include "firmware/console/job.h"
#include "firmware/console/names.h"
#include "firmware/console/output.h"
#include "firmware/dictionary/version.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

void command_obey(const editor_line_t* line, bool expired) {
  uint16_t at = 0;
  const word_t name = next_word(line, &at);
  if (name.count == 0u) return;
  const uint16_t command = command_find(&name);
  if (!command_is_here(command)) {
    refuse_name(NAME_COMMAND, &name);
    return;
  }
  words_of_line_t a;
  a.expired = expired;
  for (a.count = 0; a.count < COMMAND_WORDS; a.count++) {
    a.word[a.count] = next_word(line, &at);
    if (a.word[a.count].count == 0u) break;
  }
  edition_commands[command](&a);
}

bool command_may_move(const words_of_line_t* a) {
  if (a->expired) line_refused(SAY_the_line_is_too_old_to_move);
  return !a->expired;
}

bool command_makes_safe(const editor_line_t* line) {
  uint16_t at = 0;
  const word_t name = next_word(line, &at);
  return packed_equals(TEXT_COMMAND_NAME_stop, name.text, name.count) ||
         packed_equals(TEXT_COMMAND_NAME_coast, name.text, name.count);
}

static void put_command(uint16_t command) {
  octet_writer_t* const w = line_begin();
  put_label(w, command_name(command));
  put_packed(w, command_arguments(command));
  put_spaces_to(w, 26);
  put_packed(w, command_meaning(command));
  line_end();
}

static bool list_commands(uint16_t step) {
  if (command_is_here(step)) put_command(step);
  if (step == COMMANDS) line_of(SAY_ctrl_c_ends_a_long_answer_stop);
  return step < COMMANDS;
}

// The command that each line of help is about.
#define HELP(command, number, text) TEXT_COMMAND_##command,
static const packed_text_t explains[] = {
#include "firmware/console/all_help.h"
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
  if (explains[at] != command_meaning(explained)) return true;
  put_packed(line_begin(), (packed_text_t)(TEXT_HELP_list_1 + at));
  line_end();
  return true;
}

void command_help(const words_of_line_t* a) {
  if (a->count == 0u) {
    console_run(list_commands, false);
    return;
  }
  const uint16_t command = command_find(&a->word[0]);
  if (command_is_here(command)) {
    explained = command;
    console_run(explain, false);
  } else {
    refuse_name(NAME_COMMAND, &a->word[0]);
  }
}

void command_version(const words_of_line_t* a) {
  (void)a;
  octet_writer_t* const w = line_begin();
  put_text(w, FIRMWARE_NAME);
  put_packed(w, SAY_protocol);
  put_count(w, LINK_PROTOCOL, SAY_edition);
  put_text(w, edition_name);
  line_end();
}

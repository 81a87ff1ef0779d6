#include "firmware/console/commands.h"

#include <stddef.h>

#include "firmware/console/console.h"
#include "firmware/console/output.h"
#include "firmware/console/suggest.h"
#include "firmware/text.h"

static const command_t commands[] = {
    {"help", "[command]", "the commands, or more of one", command_help},
    {"list", "[part]", "parameters whose name or meaning contains the part; * is not the default", command_list},
    {"get", "name", "a parameter or a signal: value, range, meaning", command_get},
    {"set", "name value [unit]", "changes a parameter", command_set},
    {"save", "", "keeps the parameters for the next power-on", command_save},
    {"load", "", "puts the kept parameters in force again", command_load},
    {"defaults", "", "puts every parameter to its default; not kept until saved", command_defaults},
    {"start", "", "switches the power stage on and runs", command_start},
    {"stop", "", "brings the shaft to rest, then switches off", command_stop},
    {"coast", "", "switches off at once: the shaft runs out", command_coast},
    {"ref", "[speed [rpm]]", "speed reference; before the start or while it runs", command_ref},
    {"reset", "", "clears a latched fault", command_reset},
    {"status", "", "how the drive is", command_status},
    {"watch", "[signal ..]", "a line twice a second until a key is pressed", command_watch},
    {"faults", "", "the last faults: when, what, under which circumstances", command_faults},
    {"signals", "[part]", "signals and their values", command_signals},
    {"commission", "[start | results]", "measures machine and inverter; turns the shaft, 90 s", command_commission},
    {"scope", "[channels | trigger | every | before | mode | arm | stop | print]", "captured scope", command_scope},
    {"can", "", "the CAN node: rate, state, errors, who commands", command_can},
    {"version", "", "of this firmware", command_version},
};

#define COMMANDS ((uint16_t)(sizeof commands / sizeof commands[0]))

const command_t* command_info(uint16_t index) { return (index < COMMANDS) ? &commands[index] : NULL; }

static const command_t* find(const word_t* word) {
  for (uint16_t k = 0; k < COMMANDS; k++) {
    if (text_equals(commands[k].name, word->text, word->count)) return &commands[k];
  }
  return NULL;
}

bool word_is(const words_of_line_t* a, uint16_t k, const char* name) {
  return k < a->count && text_equals(name, a->word[k].text, a->word[k].count);
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

void command_obey(const editor_line_t* line) {
  uint16_t at = 0;
  const word_t name = next_word(line, &at);
  if (name.count == 0u) return;
  const command_t* const command = find(&name);
  if (command == NULL) {
    suggest("command", &name, suggest_command);
    return;
  }
  words_of_line_t a;
  a.count = 0;
  a.too_many = false;
  for (;;) {
    const word_t word = next_word(line, &at);
    if (word.count == 0u) break;
    a.too_many = a.count == COMMAND_WORDS;
    if (a.too_many) break;
    a.word[a.count++] = word;
  }
  command->function(&a);
}

bool command_makes_safe(const editor_line_t* line) {
  uint16_t at = 0;
  const word_t name = next_word(line, &at);
  return text_equals("stop", name.text, name.count) || text_equals("coast", name.text, name.count);
}

static void put_command(const command_t* c) {
  octet_writer_t* const w = line_begin();
  put_text(w, c->name);
  put_u8(w, ' ');
  put_text(w, c->arguments);
  put_spaces_to(w, 26);
  put_text(w, c->help);
  line_end();
}

static bool list_commands(uint16_t step) {
  if (step < COMMANDS) put_command(&commands[step]);
  if (step == COMMANDS) line_of("Ctrl-C ends a long answer; stop and coast always work. More: help <command>");
  return step < COMMANDS;
}

typedef struct {
  const char* command;
  const char* text;
} more_t;

static const more_t more[] = {
    {"list", "list            all parameters"},
    {"list", "list current    those with 'current' in name or meaning"},
    {"set", "set speed_ramp 300 rpm/s"},
    {"set", "A unit may be left out; a wrong one is refused. Values are in use at once, and gone with the power"},
    {"set", "unless they are saved. Some may not change while the power stage is on."},
    {"start", "The drive finds angle and polarity by itself, then runs at the speed of 'ref'."},
    {"ref", "ref 600 rpm     ref -50"},
    {"watch", "watch           state, speed, current, DC link"},
    {"watch", "watch load_torque current_q"},
    {"commission", "commission start      from 'ready'; the shaft must be free to turn. 'stop' ends it"},
    {"commission", "commission            how far it is"},
    {"commission", "commission results    what was measured, and why it is in use or not"},
    {"scope", "scope channels current_q speed     one to four signals (command signals)"},
    {"scope", "scope trigger speed rising 100     rising, falling, either, above, below; or: scope trigger now"},
    {"scope", "scope every 10     one record in so many control interrupts of 100 us"},
    {"scope", "scope before 256   records before the trigger, of 1024"},
    {"scope", "scope mode auto    or single"},
    {"scope", "scope arm, scope stop, scope, scope print 16     print shows one record in so many"},
};

static const command_t* explained;

static bool explain(uint16_t step) {
  if (step == 0u) {
    put_command(explained);
    return true;
  }
  const uint16_t at = (uint16_t)(step - 1u);
  if (at >= sizeof more / sizeof more[0]) return false;
  const char* const text = more[at].command;
  uint16_t length = 0;
  bool same = true;
  while (same && text[length] != '\0') {
    same = text[length] == explained->name[length];
    length++;
  }
  if (same && explained->name[length] == '\0') line_of(more[at].text);
  return true;
}

void command_help(const words_of_line_t* a) {
  if (a->count == 0u) {
    console_run(list_commands, false);
    return;
  }
  explained = find(&a->word[0]);
  if (explained != NULL) {
    console_run(explain, false);
  } else {
    suggest("command", &a->word[0], suggest_command);
  }
}

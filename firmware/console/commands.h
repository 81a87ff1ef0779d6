// The console's commands: a table of names, arguments and help, and the functions behind it in commands_*.c.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_COMMANDS_H
#define STILLSPIN_FIRMWARE_CONSOLE_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/api/guard.h"
#include "firmware/base/octets.h"
#include "firmware/console/editor.h"
#include "firmware/text/packed_text.h"

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
  word_t word[COMMAND_WORDS];  // behind the command's own; more than any command takes
  uint16_t count;
  bool expired;  // it stood for long before its end came
} words_of_line_t;

typedef void command_function_t(const words_of_line_t* a);

/// By its place in the list; PACKED_NONE behind the last one.
packed_text_t command_name(uint16_t command);
extern command_function_t* const commands[];

/// Carries a line out, or says why not. The line stays unchanged until its job is through.
void command_obey(const editor_line_t* line, bool expired);

/// For what energises or moves the motor: false, and said, when the line has expired. Whether a line does that depends
/// on its words and on the drive ('ref 0', 'commission results'): so it is asked where it is about to happen.
bool command_may_move(const words_of_line_t* a);

/// Who is to watch over what moves the motor: word k, the only one left. False, and said, when nobody would and that
/// was not asked for, or when the line has expired.
bool choose_guard(const words_of_line_t* a, uint16_t k, guard_t* guard);
/// What that means for who types.
void say_guard(guard_t guard);

/// Whether the line stops the motor, whatever else it says.
bool command_makes_safe(const editor_line_t* line);

/// True when word k is there and is this one.
bool word_is(const words_of_line_t* a, uint16_t k, const char* name);
/// The word as it was typed.
void put_word(octet_writer_t* w, const word_t* word);

/// True when word k is this text.
bool word_is_packed(const words_of_line_t* a, uint16_t k, packed_text_t text);

/// True when the word occurs in the text; one that is nowhere (text is NULL) occurs in all of them.
bool word_occurs(const word_t* word, packed_text_t text);

void command_help(const words_of_line_t* a);

void command_can(const words_of_line_t* a);         // can/commands.c
void command_commission(const words_of_line_t* a);  // commissioning/commands.c

// commands_parameters.c
void command_list(const words_of_line_t* a);
void command_get(const words_of_line_t* a);
void command_set(const words_of_line_t* a);

// commands_drive.c
void command_start(const words_of_line_t* a);
void command_stop(const words_of_line_t* a);
void command_coast(const words_of_line_t* a);
void command_look(const words_of_line_t* a);
void command_reset(const words_of_line_t* a);
void command_ref(const words_of_line_t* a);

// commands_look.c
/// What would be lost with the power, behind what the line says; nothing where nothing would.
void put_unsaved(octet_writer_t* w);
void command_status(const words_of_line_t* a);
void command_faults(const words_of_line_t* a);
void command_signals(const words_of_line_t* a);
void command_watch(const words_of_line_t* a);
void command_version(const words_of_line_t* a);

// store/commands.c
void command_save(const words_of_line_t* a);
void command_load(const words_of_line_t* a);
void command_defaults(const words_of_line_t* a);

// scope/commands.c
void command_scope(const words_of_line_t* a);

#if defined(__cplusplus)
}
#endif

#endif

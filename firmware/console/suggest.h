// For a name that does not exist: which ones were probably meant.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_SUGGEST_H
#define STILLSPIN_FIRMWARE_CONSOLE_SUGGEST_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/console/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Name number `index`, NULL behind the last one.
typedef const char* suggest_names_t(uint16_t index);

const char* suggest_parameter(uint16_t index);
const char* suggest_signal(uint16_t index);
const char* suggest_command(uint16_t index);

/// Begins the job that says: there is no <kind> '<word>', did you mean ..; names are looked through a few at a time.
void suggest(const char* kind, const word_t* word, suggest_names_t* names);

/// True when the two differ by one character that is missing, too many or wrong, or by two exchanged ones, or when the
/// name contains or begins the word.
bool suggest_is_near(const char* name, const word_t* word);

#if defined(__cplusplus)
}
#endif

#endif

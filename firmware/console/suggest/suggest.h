// For a name that does not exist: which ones were probably meant.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_SUGGEST_SUGGEST_H
#define STILLSPIN_FIRMWARE_CONSOLE_SUGGEST_SUGGEST_H

#include <stdbool.h>

#include "firmware/console/names.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Begins the job that says: there is no <kind> '<word>', did you mean ..; names are looked through a few at a time.
void suggest_names(name_kind_t kind, const word_t* word);

/// True when the two differ by one character that is missing, too many or wrong, or by two exchanged ones, or when the
/// name contains or begins the word.
bool suggest_is_near(packed_text_t name, const word_t* word);

#if defined(__cplusplus)
}
#endif

#endif

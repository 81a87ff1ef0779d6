// The names that are typed, and what is answered to one that there is not.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_NAMES_H
#define STILLSPIN_FIRMWARE_CONSOLE_NAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/console/words_of_line.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// What has names.
typedef enum { NAME_PARAMETER, NAME_SIGNAL, NAME_COMMAND } name_kind_t;

/// Answers a command with a name that there is not. A feature may look for one that was probably meant.
void refuse_name(name_kind_t kind, const word_t* word);

/// The same where nothing like it was found: there is no <kind> '<word>', and where to see which there are.
void say_no_such_name(name_kind_t kind, const word_t* word);

/// The beginning of that line.
octet_writer_t* put_no_such_name(name_kind_t kind, const word_t* word);

/// The edition's row of the table `suggest` (editions/), NULL where it has none: goes on as long as refuse_name.
typedef void suggest_t(name_kind_t kind, const word_t* word);
extern suggest_t* const edition_suggest;

/// By kind its first name among the texts, and what is behind the last one's: all names follow each other.
extern const packed_text_t first_names[];

/// False for what another edition of the firmware has.
bool name_is_here(packed_text_t name);

#if defined(__cplusplus)
}
#endif

#endif

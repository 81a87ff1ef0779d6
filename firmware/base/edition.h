// What this edition of the firmware is called, and what of the tables it has not. The tables are those of all features,
// so that a number means the same in every edition; toolchain/compose.py makes what is declared here.

#ifndef STILLSPIN_FIRMWARE_BASE_EDITION_H
#define STILLSPIN_FIRMWARE_BASE_EDITION_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

extern const char edition_name[];

/// Rows of a table, one behind the other; count 0 behind the last ones.
typedef struct {
  uint16_t first, count;
} rows_t;

/// Those that are left out, from the first to the last.
extern const rows_t edition_parameters_left_out[];  // of all_parameters.h
extern const rows_t edition_signals_left_out[];     // of all_signals.h
extern const rows_t edition_faults_left_out[];      // of all_faults.h
extern const rows_t edition_requests_left_out[];    // numbers: request_row_t.type

/// Kinds of words that are left out (text/words.h), a bit each.
extern const uint16_t edition_words_left_out;

/// Whether a row is among them.
bool rows_have(const rows_t* rows, uint16_t row);

#if defined(__cplusplus)
}
#endif

#endif

// What the drive's numbers mean, in the user's words: states, faults, limits, verdicts and phases. Every list exists
// once, in catalogue_list.h or in fault_list.h; console, link, bench and host tools read it.

#ifndef STILLSPIN_FIRMWARE_TEXT_CATALOGUE_H
#define STILLSPIN_FIRMWARE_TEXT_CATALOGUE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/text/packed_text.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// The numbers are those of the link's request WORDS: stable.
typedef enum {
  CATALOGUE_STATE = 0,          // drive_state_t
  CATALOGUE_FAULT = 1,          // drive_fault_t: the cause
  CATALOGUE_LIMIT = 2,          // number of the bit in drive_limit_t
  CATALOGUE_VERDICT = 3,        // commissioning_verdict_t
  CATALOGUE_PHASE = 4,          // commissioning_phase_t
  CATALOGUE_STORE = 5,          // store_state_t
  CATALOGUE_STATUS = 6,         // answer_status_t
  CATALOGUE_START = 7,          // start_phase_t
  CATALOGUE_REMEDY = 8,         // drive_fault_t: what to do about it
  CATALOGUE_COMMISSIONING = 9,  // commissioning_outcome_t
  CATALOGUE_SCOPE = 10,         // scope_state_t
  CATALOGUE_CAN = 11,           // hal_can_state_t
  CATALOGUE_BOARD = 12,         // board_words_t
  CATALOGUE_SELFTEST = 13,      // number of the bit in selftest_failure_t, and more (board/selftest.c)
  CATALOGUE_WIRING = 14,        // wiring_t
  CATALOGUE_LOOK = 15           // look_outcome_t; behind 2, 3 and 4 comes a speed
} catalogue_t;

#define CATALOGUES 16u

/// Whether any edition has such a kind, and such a code in it.
bool message_is_known(uint16_t kind, uint16_t code);

/// Of a feature that this edition has not.
bool message_is_left_out(uint16_t kind, uint16_t code);

/// Known, and in this edition.
bool message_exists(uint16_t kind, uint16_t code);

/// Writes them out; "?" when there are none.
void put_message(octet_writer_t* w, catalogue_t kind, uint16_t code);

#if defined(__cplusplus)
}
#endif

#endif

// Looks for the slot that counts: the newer of the valid ones. Leaves its values staged when they are wanted.

#ifndef STILLSPIN_FIRMWARE_STORE_SCAN_H
#define STILLSPIN_FIRMWARE_STORE_SCAN_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/store/store.h"

typedef enum {
  SCAN_GOES_ON = 0,
  SCAN_FOUND = 1,
  SCAN_EMPTY = 2,
  SCAN_DAMAGED = 3,
  SCAN_FOREIGN = 4,  // the valid ones have another version
  SCAN_FAILED = 5    // the memory cannot be read
} scan_result_t;

/// `stage`: puts the slot's values into values.h's set, in the place of the defaults.
void scan_begin(bool stage);

/// To be called again until it does not go on.
scan_result_t scan_step(void);

/// What it has found; slot SLOTS when none is valid. `sequence` is the newest of the valid ones, of whatever version.
const store_report_t* scan_report(void);

uint16_t scan_progress(void);

#endif

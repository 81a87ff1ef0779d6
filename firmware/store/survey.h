// Looks for the slot that counts: the newer of the valid ones. Leaves its values staged when they are wanted.

#ifndef STILLSPIN_FIRMWARE_STORE_SURVEY_H
#define STILLSPIN_FIRMWARE_STORE_SURVEY_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/store/store.h"

typedef enum {
  SURVEY_GOES_ON = 0,
  SURVEY_FOUND = 1,
  SURVEY_EMPTY = 2,
  SURVEY_DAMAGED = 3,
  SURVEY_FOREIGN = 4,  // the valid ones have another version
  SURVEY_FAILED = 5    // the memory cannot be read
} survey_result_t;

/// `stage`: puts the slot's values into values.h's set, in the place of the defaults.
void survey_begin(bool stage);

/// To be called again until it does not go on.
survey_result_t survey_step(void);

/// What it has found; slot SLOTS when none is valid. `sequence` is the newest of the valid ones, of whatever version.
const store_report_t* survey_report(void);

uint16_t survey_progress(void);

#endif

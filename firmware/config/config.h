// From parameters to constants of every module.

#ifndef STILLSPIN_FIRMWARE_CONFIG_CONFIG_H
#define STILLSPIN_FIRMWARE_CONFIG_CONFIG_H

#include "firmware/mode/mode.h"
#include "firmware/text/packed_text.h"

/// Makes a configuration of the parameters, background level only: PACKED_NONE, or why they do not fit together, a
/// sentence. What a pair of the drive's own has against each other says config/rules.h.
packed_text_t drive_config_make(void);
/// What was made last is in use from here on, with the features' parts of it: no control interrupt comes in between.
void drive_config_take(drive_config_t* c);
/// Both; false, with the old one kept, when they do not fit together.
static inline bool drive_config_load(drive_config_t* c) {
  const bool fits = drive_config_make() == PACKED_NONE;
  if (fits) drive_config_take(c);
  return fits;
}

#endif

// From parameters to constants of every module.

#ifndef STILLSPIN_FIRMWARE_CONFIG_CONFIG_H
#define STILLSPIN_FIRMWARE_CONFIG_CONFIG_H

#include "firmware/mode/mode.h"
#include "firmware/text/packed_text.h"

/// Makes a configuration of the parameters, background level only; NULL when they do not fit together. What it points
/// to is good until the next one is made.
const drive_config_t* drive_config_make(void);
/// What was made last is in use from here on, with the features' parts of it: no control interrupt comes in between.
void drive_config_take(drive_config_t* c, const drive_config_t* made);
/// Both; false, with the old one kept, when they do not fit together.
bool drive_config_load(drive_config_t* c);
/// Makes a configuration if the parameters fit together: PACKED_NONE, or why they do not, in a sentence
/// (config/rules.c).
packed_text_t drive_config_or_conflict(const drive_config_t** made);

#endif

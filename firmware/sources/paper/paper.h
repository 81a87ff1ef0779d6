// The low-speed estimator of the paper's scheme.

#ifndef STILLSPIN_FIRMWARE_SOURCES_PAPER_H
#define STILLSPIN_FIRMWARE_SOURCES_PAPER_H

#include "estimators/zvv.h"
#include "firmware/mode/mode.h"

extern zvv_t paper_zvv;

/// Its part of the configuration (interfaces/config_part.h).
bool paper_load(drive_config_t* c);

/// As after power-on.
void paper_reset(void);

#endif

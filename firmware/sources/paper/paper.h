// The low-speed estimator of the paper's scheme.

#ifndef STILLSPIN_FIRMWARE_SOURCES_PAPER_H
#define STILLSPIN_FIRMWARE_SOURCES_PAPER_H

#include "estimators/zvv.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/mode/mode.h"

extern zvv_t paper_zvv;

/// Its constants in use.
extern zvv_config_t paper_config;
extern const config_part_t paper_part;

/// ZVV below the blend, AVV above.
extern const position_source_t paper_source;

/// As after power-on.
void paper_reset(void);

#endif

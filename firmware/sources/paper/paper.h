// The low-speed estimator of the paper's scheme.

#ifndef STILLSPIN_FIRMWARE_SOURCES_PAPER_H
#define STILLSPIN_FIRMWARE_SOURCES_PAPER_H

#include "estimators/zvv.h"

extern zvv_t paper_zvv;

/// As after power-on.
void paper_reset(void);

#endif

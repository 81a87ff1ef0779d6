// Position of the incremental encoder, for tests and for measuring a sensorless drive; the drive does not need it.
//
// The count is in quadrature edges (four a line) and runs 0..counts_per_turn - 1, up for a before b. It starts at 0
// wherever the shaft is: the index pulse is not used, so the offset to the rotor has to be found by whoever needs it.

#ifndef STILLSPIN_HAL_HAL_ENCODER_H
#define STILLSPIN_HAL_HAL_ENCODER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// counts_per_turn: quadrature edges of one mechanical turn, at least 4 (1024 lines: 4096). Needs hal_clock_init.
void hal_encoder_init(uint32_t counts_per_turn);

// The position now, 0..counts_per_turn - 1. Read it at the same place of every period.
uint32_t hal_encoder_count(void);

#ifdef __cplusplus
}
#endif

#endif

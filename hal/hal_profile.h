// Run times for the model of the chip.
//
// A register access takes its time in the model by itself; arithmetic does not. A step of the control that takes long
// says here how long, so that what follows it happens as late as on the chip. The image is compiled with a header in
// the place of this one by which nothing is called. So it is no call that a recording counts (hal_replay.h).

#ifndef STILLSPIN_HAL_HAL_PROFILE_H
#define STILLSPIN_HAL_HAL_PROFILE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// The code since the last register access takes this many CPU cycles of 10 ns on the chip.
void hal_profile_step(uint16_t cycles);

#ifdef __cplusplus
}
#endif

#endif

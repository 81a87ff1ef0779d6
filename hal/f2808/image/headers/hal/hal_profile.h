// In the place of hal/hal_profile.h in the image: on the chip time passes by itself.

#ifndef STILLSPIN_HAL_HAL_PROFILE_H
#define STILLSPIN_HAL_HAL_PROFILE_H

#include <stdint.h>

static inline void hal_profile_step(uint16_t cycles) { (void)cycles; }

#endif

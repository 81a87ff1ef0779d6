#include "hal/f2808/target.h"
#include "hal/hal_profile.h"

void hal_profile_step(uint16_t cycles) { target_elapse(cycles); }

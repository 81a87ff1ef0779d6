// Clocks of the chip: CPU and PWM 100 MHz from a 20 MHz crystal, ADC 12.5 MHz, low-speed peripherals 50 MHz.

#ifndef STILLSPIN_HAL_HAL_CLOCK_H
#define STILLSPIN_HAL_HAL_CLOCK_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

// Stops the watchdog, brings the PLL up, sets flash wait states and gives the peripherals their clocks; the PWM time
// bases stay stopped. Call it first. Takes about 7 ms. Returns false when the crystal is dead or the PLL does not lock:
// the chip then runs at an unknown low clock and nothing else may be set up.
bool hal_clock_init(void);

#ifdef __cplusplus
}
#endif

#endif

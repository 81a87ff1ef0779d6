// Slices: the other way to run the legs. In place of a pulse per leg and period each leg's level is set directly, from
// an interrupt that comes every few microseconds with fresh currents. For control laws that decide sample by sample,
// such as hysteresis control.
//
// The period of hal_pwm.h and its control interrupt go on; hal_pwm_write must not be called meanwhile. The slice
// interrupt takes the place of the window interrupt: it is the same function, and must call hal_sampling_timer_read
// first. A level that is set acts at once, its leading edge delayed by the dead band. Trips and hal_pwm_gates_off work
// as ever.

#ifndef STILLSPIN_HAL_HAL_SAMPLING_TIMER_H
#define STILLSPIN_HAL_HAL_SAMPLING_TIMER_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_SAMPLING_TIMER_MIN_TICKS 500u  // 5 us: two conversions, the interrupt and some 250 cycles for the law

// One sample of each, as codes of 12 bits.
typedef struct {
  uint16_t current_a, current_b;  // sampled at the same instant
  uint16_t link;
} hal_timed_samples_t;

// All legs low, then slices of this many ticks of 10 ns. Returns false, with nothing changed, unless a whole number of
// them makes a period and each has HAL_SAMPLING_TIMER_MIN_TICKS. From the control interrupt.
bool hal_sampling_timer_begin(uint16_t slice_ticks);

// Back to pulses and windows; no pulse until the next hal_pwm_write. From the control interrupt.
void hal_sampling_timer_end(void);

// Takes the results and acknowledges the interrupt.
void hal_sampling_timer_read(hal_timed_samples_t* slice);

// Bit k: leg k high.
void hal_sampling_timer_set_legs(uint16_t state);

#ifdef __cplusplus
}
#endif

#endif

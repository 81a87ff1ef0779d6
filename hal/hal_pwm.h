// Three inverter legs and the three measuring windows of a PWM period.
//
// The time base counts up from 0 to HAL_PWM_PERIOD_TICKS - 1 in ticks of 10 ns and starts again: 10 kHz. In every
// period each leg has one pulse of its upper device, given by the ticks of its two edges; edges may lie anywhere, so a
// pulse need not be centred. The lower device is the complement, with the dead band taken off the leading edge of both.
// Each of the three windows starts two bursts of conversions (hal_adc.h) at its own two ticks.
//
// What is written takes effect as a whole at the next period start. The gates are off after hal_pwm_init and stay off
// until hal_pwm_gates_on; a leg without a pulse and with its gates on has its lower device on.

#ifndef STILLSPIN_HAL_HAL_PWM_H
#define STILLSPIN_HAL_HAL_PWM_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/qmath/period.h"

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_PWM_LEGS 3u
#define HAL_PWM_WINDOWS 3u
#define HAL_PWM_PERIOD_TICKS ((uint16_t)PERIOD_TICKS)
#define HAL_PWM_LAST_TICK (PERIOD_TICKS - 1u)  // the last tick of a period at which an edge or a burst can be
#define HAL_PWM_NONE 0xFFFFu                   // as the tick of an edge: no pulse; as a burst tick: no burst
#define HAL_PWM_DEAD_BAND_MIN_TICKS 1u         // 10 ns; the power stage asks for far more
#define HAL_PWM_DEAD_BAND_MAX_TICKS 1023u      // 10.23 us
#define HAL_PWM_WRITE_TICKS 120u               // hal_pwm_write takes no longer than this from its look at the counter

// One period, ticks of 10 ns from the period start.
typedef struct {
  uint16_t
      edge_tick[2u * HAL_PWM_LEGS];  // the legs' upper devices on, then off: 1 <= on < off <= 9999; > 9999: no pulse
  uint16_t burst_start_tick[HAL_PWM_WINDOWS];  // first burst of the window, 1..9999; > 9999: none
  uint16_t burst_end_tick[HAL_PWM_WINDOWS];    // last burst of the window, 1..9999; > 9999: none
} hal_pwm_frame_t;

// Sets up time bases, dead band, trip action and pins, then starts the counters; no pulses, no bursts, gates off.
// Needs hal_clock_init. dead_band_ticks: 1..1023. Returns false and sets nothing up when it is outside that range.
bool hal_pwm_init(uint16_t dead_band_ticks);

// Changes the dead band, with the gates off only. Returns false, with the old one kept, when it is outside 1..1023 or
// the gates are on: the dead band has no shadow, so a change under way could make one dead time too short.
bool hal_pwm_set_dead_band(uint16_t dead_band_ticks);

// Hands over the next period, from the control interrupt. Returns false, with nothing written, when the counter has
// already passed deadline_tick or a further period has begun: the last frame is then repeated. Choose deadline_tick <=
// HAL_PWM_LAST_TICK - HAL_PWM_WRITE_TICKS, or part of a frame may come a period late. Interrupts are held off
// meanwhile. The frame is not checked: the modulator's job.
bool hal_pwm_write(const hal_pwm_frame_t* frame, uint16_t deadline_tick);

// Where the period is now, 0..9999.
uint16_t hal_pwm_period_tick(void);

// Lets the gates follow the pulses again. Returns false, with the gates still off, while the over-current input is low.
bool hal_pwm_gates_on(void);

// Switches both devices of every leg off at once and keeps them off. May be called at any time, from any level.
void hal_pwm_gates_off(void);

// True while the gates are held off, whoever did it.
bool hal_pwm_is_tripped(void);

// True when the over-current input has switched the gates off since the last hal_pwm_gates_on, also when
// hal_pwm_gates_off came first or afterwards. Needs hal_safety_init.
bool hal_pwm_was_tripped_by_pin(void);

#ifdef __cplusplus
}
#endif

#endif

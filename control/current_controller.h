// Current control in the rotor frame: two PI controllers with bandwidth a (Kp = a L) and the integrator's corner at
// a/4 or R/L, whichever is higher, the rotational voltages fed forward and anti-windup from the voltage that the
// modulator really gives.
//
// The corner is not always the machine's own R/L, as internal-model control has it: what the dead time leaves over is a
// voltage disturbance that turns with the current, and with R/L it would decay in L/R, 24 ms on the q-axis of motor A,
// far too slow for the speed loop. Where R/L is above a/4 = 450 rad/s, as on small motors (up to 5000 rad/s), with a/4
// the current would follow by a/4 K_p/(R + K_p) only. The corner ends at half a step. The measurement is taken over the
// last period and the voltage acts in the middle of the next but one: two periods of delay. a = 1800 rad/s leaves about
// 57 degrees of phase margin at 10 kHz; more than 2600 rad/s is refused.
//
// The controllers may step every n-th period only, the voltage still acting from the next reload on; holding it for n
// periods adds (n - 1)/2 periods of delay, and the largest bandwidth falls in proportion. Seed paper B steps at 5 kHz
// with n = 2, and its printed gains are this design with the integrator's corner at R/L and a = 2 pi 1000 rad/s: Kp = a
// L = 4.775 (d), 10.24 (q, printed 10.116) V/A, Ki = a R = 1099.6 V/(A s). With a full 200 us of delay behind the
// sample that is unstable (a 200 us > 1). With the voltage at the next reload of 10 kHz, as here, it is stable by 6 %
// of the gain, overshoots by 97 % and would not bear an inductance that saturates: refused, at most 2080 rad/s is left.

#ifndef STILLSPIN_CONTROL_CURRENT_CONTROLLER_H
#define STILLSPIN_CONTROL_CURRENT_CONTROLLER_H

#include <stdbool.h>

#include "control/machine_model.h"
#include "control/pi.h"

// No DC link is above 2000 V: a command of twice that says all, and sums with it stay in their format.
#define CURRENT_COMMAND_BITS 28u
#define CURRENT_COMMAND_END_Q16 ((int32_t)1 << CURRENT_COMMAND_BITS)

typedef struct {
  pi_config_t d, q;
} current_controller_config_t;

typedef struct {
  pi_state_t d, q;
} current_controller_t;

typedef enum { CURRENT_CORNER_HIGHER = 0, CURRENT_CORNER_MACHINE = 1 } current_corner_t;

typedef struct {
  int32_t bandwidth_rads;   // a, 100..2600 at a step in every period of 100 us, to 2080 at every other
  int32_t period_us;        // PWM period
  int32_t divider;          // n: periods per step, 1..2
  current_corner_t corner;  // of the integrator: a/4, or R/L of the machine where that is higher; or R/L
} current_design_t;

/// Derives the gains.
void current_controller_design(current_controller_config_t* c, const machine_model_t* m,
                               const current_design_t* design);

void current_controller_reset(current_controller_t* s);

/// One step: currents in A Q20, speed in binary angle per period; returns the voltage command in V Q16, at most 4096 V
/// along each axis. Inline, as current control alone calls it.
static inline dq_t current_controller_step(current_controller_t* s, const current_controller_config_t* c,
                                           const machine_model_t* m, dq_t reference_q20, dq_t measured_q20,
                                           int32_t speed_bpp) {
  const dq_t rotational = machine_rotational_voltage_q16(m, measured_q20, speed_bpp);
  dq_t v;
  v.d = pi_step(&s->d, &c->d, reference_q20.d - measured_q20.d, rotational.d, CURRENT_COMMAND_BITS);
  v.q = pi_step(&s->q, &c->q, reference_q20.q - measured_q20.q, rotational.q, CURRENT_COMMAND_BITS);
  return v;
}

/// Reports the part of the command that the modulator had to drop (asked minus realised, V Q16).
void current_controller_limited(current_controller_t* s, const current_controller_config_t* c, dq_t excess_q16);

#endif

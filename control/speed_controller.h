// Speed control: the predictive controller with load compensation, and a PI controller for comparison.
//
// Predictive (seed paper, section 7, eqs (45)-(55)). With the load compensated, the shaft obeys
//   w(n+1) = a w(n) + b i(n),   a = exp(-B Ts / J),   b = Kt Ts / J * (1 - x/2 + x^2/6), x = B Ts / J    (47)-(49)
// and minimising alpha (w(n+1) - w_r(n+1))^2 + (delta i)^2 gives
//   delta i = k [w_r(n+1) - a w(n) - b i(n-1)],   k = alpha b / (alpha b^2 + 1)                          (53), (54)
// Two things are added to the paper. The target w_r(n+1) is a reference trajectory that starts at the measured speed
// and closes the distance with a time constant: with w_r = w* itself, which a time constant below two steps stands for,
// the loop has poles at z^2 - (2 - 2kb) z + (1 - kb), which ring for every kb below one and amplify the estimator's
// noise as kb approaches it. And the load is not the differentiated speed of the paper's Fig. 7 but the load torque
// that the position observer carries as a state.
//
// PI: pole assignment for J s w = Kt i - B w with the damping and frequency given; integrator with conditional release.
//
// Speeds are electrical, in binary angle per PWM period (bpp); currents A Q20; the step is one speed period (1 ms).

#ifndef STILLSPIN_CONTROL_SPEED_CONTROLLER_H
#define STILLSPIN_CONTROL_SPEED_CONTROLLER_H

#include <stdbool.h>

#include "control/machine_model.h"

typedef enum { SPEED_PREDICTIVE = 0, SPEED_PI = 1 } speed_law_t;

typedef struct {
  int32_t friction_q24;      // B, N m s per rad, 0..1
  int32_t inertia_q24;       // J, kg m^2, 1e-5..1
  int32_t step_periods;      // speed period in PWM periods, 1..100
  int32_t alpha_q8;          // weight of the predicted speed error, A^2 s^2 / rad^2, 1..100000
  int32_t trajectory_ms_q8;  // time constant of the reference trajectory, 1..200 ms
  int32_t pi_bandwidth_q8;   // natural frequency of the PI loop, rad/s, 1..200
  int32_t pi_damping_q12;    // its damping, 0.3..60
} speed_controller_config_t;

/// What depends on the acceleration per ampere.
typedef struct {
  int32_t share_q30;     // k b, 0..1
  int32_t amps_per_bpp;  // 1/b, A per bpp, Q40
  int32_t pi_kp, pi_ki;  // A per bpp, Q40
} speed_gains_t;

typedef struct {
  int32_t decay_q30;     // a
  int32_t response_q8;   // b, bpp per A
  int32_t approach_q30;  // 1 - exp(-Ts / trajectory), or 1
  speed_gains_t gains;
  speed_gains_t nominal;  // of the parameters
  int32_t current_q20;    // i(n-1) of the predictive law
  int32_t integral_q20;   // of the PI law
} speed_controller_t;

typedef struct {
  int32_t reference_bpp;            // w*(n)
  int32_t reference_step_bpp;       // w*(n+1) - w*(n), the ramp
  int32_t speed_bpp;                // measured or estimated
  int32_t load_current_q20;         // current that balances the estimated load, A
  int32_t lowest_q20, highest_q20;  // i_q allowed now, A: up to zero, from zero
} speed_controller_input_t;

/// Derives the gains. Returns false when the rotor is so heavy or light that an ampere changes the speed by less than
/// 512 or more than 8 million bpp in a step, or stops by friction within two steps.
bool speed_controller_init(speed_controller_t* s, const speed_controller_config_t* c, const machine_model_t* m);

/// Gains for an acceleration per ampere that is this ratio (Q24, 1/8 to 8) of the one that the parameters say.
void speed_controller_scale(speed_controller_t* s, int32_t ratio_q24);

/// Makes the next step start from this current, e.g. at a change of mode.
void speed_controller_preset(speed_controller_t* s, int32_t current_q20);

/// One step of the chosen law; returns i_q*, A Q20, within the limits.
int32_t speed_controller_step(speed_controller_t* s, speed_law_t law, const speed_controller_input_t* in);

#endif

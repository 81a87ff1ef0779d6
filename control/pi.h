// Proportional-integral controller with a limit that is imposed from outside (anti-windup by back-calculation).
//
// P = Kp e;  I += c P;  u = P + I + what is fed forward.
//
// c is the corner of the integrator times a step: Ki T / Kp. When the actuator could not follow, pi_limited() lets the
// integrator run towards the value with which the output would have been the realised one, at the rate `release` (a few
// times c), so that a long limit does not wind it up and a short one, where the proportional part alone is limited,
// does not empty it.
//
// Both parts are kept in Q20 and within 1024 V, so that their sum stays in 31 bits: a link of 1500 V gives 1000 V along
// an axis, and what the rotation induces is fed forward beside them. A step rounds the integral down, half a unit of
// 2^-20 V in the mean, which a mean error of 0.5e-6 V / (c Kp) makes up for: 0.1 mA with 0.05 mH and 1800 rad/s, 40 mA
// with the lowest bandwidth of 100 rad/s.

#ifndef STILLSPIN_CONTROL_PI_H
#define STILLSPIN_CONTROL_PI_H

#include "hal/qmath/qmath.h"

#define PI_PART_BITS 30u          // either part, V Q20
#define PI_FEED_FORWARD_BITS 30u  // what is fed forward, V Q16

typedef struct {
  int32_t kp_q20;       // V per A
  int32_t corner_q32;   // c, share of the proportional part that the integrator takes over per step, 0..0.5
  int32_t release_q20;  // share of the excess taken off the integrator per step, 0..1
} pi_config_t;

typedef struct {
  int32_t integral_q20;  // V
} pi_state_t;

static inline void pi_reset(pi_state_t* s) { s->integral_q20 = 0; }

/// One step: error in A Q20, what is fed forward in V Q16; returns the output, V Q16, within 2^bits, bits up to 30.
static inline int32_t pi_step(pi_state_t* s, const pi_config_t* c, int32_t error_q20, int32_t feed_forward_q16,
                              unsigned bits) {
  const int32_t part_q20 = q_sat_bits(q_product(error_q20, c->kp_q20), 20, PI_PART_BITS);
  s->integral_q20 = q_within_bits(s->integral_q20 + q_mul_hi(part_q20, c->corner_q32), PI_PART_BITS);
  return q_within_bits(q_shr(s->integral_q20 + part_q20, 4) + q_within_bits(feed_forward_q16, PI_FEED_FORWARD_BITS),
                       bits);
}

/// Tells the controller what became of its output: `excess` = asked minus realised, V Q16.
static inline void pi_limited(pi_state_t* s, const pi_config_t* c, int32_t excess_q16) {
  const int32_t off_q20 = q_sat_bits(q_product(excess_q16, c->release_q20), 16, PI_PART_BITS);
  s->integral_q20 = q_within_bits(s->integral_q20 - off_q20, PI_PART_BITS);
}

#endif

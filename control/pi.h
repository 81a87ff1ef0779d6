// Proportional-integral controller with a limit that is imposed from outside (anti-windup by back-calculation).
//
// u = Kp e + I;  I += Ki T e. When the actuator could not follow, pi_limited() lets the integrator run towards the
// value with which the output would have been the realised one, at the rate `release` (a few times Ki/Kp), so that a
// long limit does not wind it up and a short one, where the proportional part alone is limited, does not empty it.

#ifndef STILLSPIN_CONTROL_PI_H
#define STILLSPIN_CONTROL_PI_H

#include "hal/qmath/qmath.h"

// An error in Q20 (A) times a gain in Q20 is an output in Q16 (V) behind a shift by 24; the integral has four more
// bits.
#define PI_ERROR_SHIFT 24u
#define PI_FEED_ONE 16777216L     // 2^24
#define PI_INTEGRAL_ONE 1048576L  // 2^20

typedef struct {
  int32_t kp_q20;       // output per error, both in their own units
  int32_t ki_q20;       // per step
  int32_t release_q20;  // share of the excess taken off the integrator per step, 0..1
} pi_config_t;

typedef struct {
  int32_t integral;  // output units with four more fractional bits
} pi_state_t;

static inline void pi_reset(pi_state_t* s, int32_t output) { s->integral = q_shl_sat(output, 4); }

/// One step; returns the output with what is fed forward, within 2^bits.
static inline int32_t pi_step(pi_state_t* s, const pi_config_t* c, int32_t error, int32_t feed, unsigned bits) {
  const int64_t grown = q_mac(q_product(error, c->ki_q20), s->integral, PI_INTEGRAL_ONE) + PI_INTEGRAL_ONE / 2;
  s->integral = q_sat64(q_shr64(grown, PI_ERROR_SHIFT - 4u));
  const int64_t held = q_mac(q_product(s->integral, PI_INTEGRAL_ONE), feed, PI_FEED_ONE);
  return q_sat_bits(q_mac(held, error, c->kp_q20), PI_ERROR_SHIFT, bits);
}

/// Tells the controller what became of its output: `excess` = asked minus realised.
static inline void pi_limited(pi_state_t* s, const pi_config_t* c, int32_t excess) {
  s->integral = q_sub_sat(s->integral, q_mul_sat(excess, c->release_q20, 16));
}

#endif

// What the windows of a period say of angle and speed: information and score, for the deviation observer.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_INFORMATION_H
#define STILLSPIN_ESTIMATORS_DEVIATION_INFORMATION_H

#include "estimators/deviation_observer.h"

#define GAIN_END_Q17 134217728L  // 1024 A per period and rad; six squares stay in 64 bits
#define INFORMATION_MAX (8L * 16777216L)

typedef struct {
  int32_t aa, as, ss;  // Q24
  int32_t a, s;        // score, Q20
} information_t;

// Information and score while the windows add to them. A window weighs the square of its span, in whole ticks times 16:
// an upper word of a product with it is 1 / PER_UNIT of a number that is weighed with the square of its share in the
// period. h_speed is the same for all windows: what belongs to it is multiplied once.
typedef struct {
  int64_t aa_q34, a_q37;  // h_angle^2, h_angle e
  dq_t h_q17, e_q20;      // h_angle, e
  int32_t weight;         // sum of all weights: the windows of a period do not overlap
} information_sums_t;

static inline void information_collect(information_sums_t* n, int32_t limit_q20, const deviation_sensitivity_t* h,
                                       int32_t span, const deviation_t* d) {
  const int32_t weight = span * span * 16;
  const dq_t by_angle = deviation_by_angle_q17(h, d->voltage_q16);
  const dq_t g = {q_limit(by_angle.d, GAIN_END_Q17), q_limit(by_angle.q, GAIN_END_Q17)};
  const dq_t e = {q_limit(d->residual_q20.d, limit_q20), q_limit(d->residual_q20.q, limit_q20)};
  const dq_t wg = {q_mul_hi(g.d, weight), q_mul_hi(g.q, weight)};
  n->aa_q34 = q_mac(q_mac(n->aa_q34, g.d, wg.d), g.q, wg.q);
  n->a_q37 = q_mac(q_mac(n->a_q37, e.d, wg.d), e.q, wg.q);
  n->h_q17.d += wg.d;
  n->h_q17.q += wg.q;
  n->e_q20.d += q_mul_hi(e.d, weight);
  n->e_q20.q += q_mul_hi(e.q, weight);
  n->weight += weight;
}

static inline int32_t per_noise_sat(const deviation_observer_config_t* c, int64_t sum, unsigned shift) {
  return q_sat64(q_shr64(q_product(q_sat64(q_shr64(sum, shift)), c->weight_q8), 18));
}

static inline int32_t per_noise(const deviation_observer_config_t* c, int64_t sum, unsigned shift) {
  return q_mul_floor(q_sat64(q_shr64(sum, shift)), c->weight_q8, 18);
}

// More information than the formats hold counts as less, all of it alike, or the update would overshoot.
static inline information_t bounded(const information_t* n) {
  const int32_t share_q30 = q_div(INFORMATION_MAX, q_max(n->aa, n->ss), 30);
  const information_t less = {q_clamp(q_mul(n->aa, share_q30, 30), 0, INFORMATION_MAX), q_mul(n->as, share_q30, 30),
                              q_clamp(q_mul(n->ss, share_q30, 30), 0, INFORMATION_MAX), q_mul(n->a, share_q30, 30),
                              q_mul(n->s, share_q30, 30)};
  return less;
}

// In units of the states and of the noise: of angle 2^-6 rad, of speed 2^-12 rad per period, in Q24, scores in Q20.
// Where the information is within its bound, 8, so are the rest: its product aa ss is not below the square of as, and a
// score not above 272 times the root of it (OUTLIER in both axes).
static inline information_t information_of(const information_sums_t* n, const deviation_observer_config_t* c,
                                           dq_t h_s) {
  const int64_t as_q37 = q_mac(q_product(h_s.d, n->h_q17.d), h_s.q, n->h_q17.q);
  const uint32_t turn2_q8 = (uint32_t)((q_square(h_s.d) + q_square(h_s.q)) >> 32);
  const uint32_t ss_q10 = (uint32_t)(((uint64_t)turn2_q8 * (uint32_t)n->weight) >> 30);
  const int64_t s_q40 = q_mac(q_product(h_s.d, n->e_q20.d), h_s.q, n->e_q20.q);
  const int32_t aa = per_noise_sat(c, n->aa_q34, 12);
  const int32_t ss = q_sat64((int64_t)(((uint64_t)ss_q10 * (uint32_t)c->weight_q8) >> 18));
  if (aa > INFORMATION_MAX || ss > INFORMATION_MAX) {
    const information_t large = {aa, per_noise_sat(c, as_q37, 21), ss, per_noise_sat(c, n->a_q37, 13),
                                 per_noise_sat(c, s_q40, 22)};
    return bounded(&large);
  }
  const information_t i = {aa, per_noise(c, as_q37, 21), ss, per_noise(c, n->a_q37, 13), per_noise(c, s_q40, 22)};
  return i;
}

#endif

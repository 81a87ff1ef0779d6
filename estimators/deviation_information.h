// What the windows of a period say of angle and speed: information and score, for the deviation observer.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_INFORMATION_H
#define STILLSPIN_ESTIMATORS_DEVIATION_INFORMATION_H

#include "estimators/deviation_observer.h"

#define INFORMATION_MAX (8L * 16777216L)

typedef struct {
  int32_t aa, as, ss;  // Q24
  int32_t a, s;        // score, Q20
} information_t;

// Information and score while the windows add to them. h is that of a slope; what makes a change of the current of it
// is a window's share in the period. The variance is taken to grow with this share: conversions are as noisy in every
// window, but what the model has wrong is not. An inductance that it lacks leaves dY (v - e) in each slope, with e the
// period's mean voltage, and the changes that it makes add up to nothing over a period, as the current's own do. Only
// changes of the same weight keep that, and a score of slopes over such a variance has them so. h_speed is the same for
// all windows: what belongs to it is multiplied once.
typedef struct {
  int64_t aa_q32, a_q34;  // h_angle^2 share, h_angle e
  dq_t h_q15, e_q17;      // h_angle share, e
  int32_t span_ticks;
} information_sums_t;

static inline void information_collect(information_sums_t* n, int32_t limit_q19, const deviation_sensitivity_t* h,
                                       const estimator_window_t* w, const deviation_change_t* c) {
  const int32_t share_q30 = estimator_share_q30(w);
  const dq_t by_angle = deviation_by_angle_q17(h, c->mirrored_q15);
  const int32_t limit_q17 = q_mul_hi(limit_q19, share_q30);
  const dq_t e = {q_limit(c->left_q17.d, limit_q17), q_limit(c->left_q17.q, limit_q17)};
  n->a_q34 = q_mac(q_mac(n->a_q34, by_angle.d, e.d), by_angle.q, e.q);
  n->e_q17.d += e.d;
  n->e_q17.q += e.q;
  const dq_t g = {q_mul_hi(by_angle.d, share_q30), q_mul_hi(by_angle.q, share_q30)};
  n->aa_q32 = q_mac(q_mac(n->aa_q32, by_angle.d, g.d), by_angle.q, g.q);
  n->h_q15.d += g.d;
  n->h_q15.q += g.q;
  n->span_ticks += w->span_ticks;
}

static inline int32_t per_noise_sat(const deviation_observer_config_t* c, int64_t sum, unsigned shift) {
  return q_sat64(q_shr64(q_product(q_sat64(q_shr64(sum, shift)), c->weight_q8), 17));
}

static inline int32_t per_noise(const deviation_observer_config_t* c, int64_t sum, unsigned shift) {
  return q_mul_floor(q_sat64(q_shr64(sum, shift)), c->weight_q8, 17);
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
// score not above 157 times the root of it (OUTLIER sqrt(2 / NOISE_SHARE), with windows as long as the period).
static inline information_t information_of(const information_sums_t* n, const deviation_observer_config_t* c,
                                           dq_t h_s) {
  const int64_t as_q35 = q_mac(q_product(h_s.d, n->h_q15.d), h_s.q, n->h_q15.q);
  const uint32_t turn2_q8 = (uint32_t)((q_square(h_s.d) + q_square(h_s.q)) >> 32);
  const uint32_t ss_q8 = (uint32_t)(((uint64_t)turn2_q8 * (uint32_t)estimator_span_q30(n->span_ticks)) >> 30);
  const int64_t s_q37 = q_mac(q_product(h_s.d, n->e_q17.d), h_s.q, n->e_q17.q);
  const int32_t aa = q_max(per_noise_sat(c, n->aa_q32, 11), 0);  // a sum of squares, which no interval shows
  const int32_t ss = q_sat64((int64_t)(((uint64_t)ss_q8 * (uint32_t)c->weight_q8) >> 16));
  if (aa > INFORMATION_MAX || ss > INFORMATION_MAX) {
    const information_t large = {aa, per_noise_sat(c, as_q35, 20), ss, per_noise_sat(c, n->a_q34, 11),
                                 per_noise_sat(c, s_q37, 20)};
    return bounded(&large);
  }
  const information_t i = {aa, per_noise(c, as_q35, 20), ss, per_noise(c, n->a_q34, 11), per_noise(c, s_q37, 20)};
  return i;
}

#endif

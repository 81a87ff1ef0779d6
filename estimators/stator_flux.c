#include "estimators/stator_flux.h"

#define ONE_Q30 ((int32_t)1073741824L)
#define ONE_Q28 ((int32_t)268435456L)
#define LEAST_SQUARE_Q28 (ONE_Q28 / 17)  // w^2/(w^2 + w_c^2) at a quarter of the cut-off
#define SHARE_END_Q24 69206016L          // 4.125: the root of 17

static int32_t length_of(ab_t v) { return q_hypot(v.alpha, v.beta); }

void stator_flux_preset(stator_flux_t* s, ab_t flux_q16) {
  static const ab_t all = {ONE_Q28, 0};
  s->flux_q16 = flux_q16;
  s->length_q16 = length_of(flux_q16);
  s->compensation_q16 = s->length_q16;
  s->shown_q28 = all;
}

// The trapezoidal rule: psi+ - psi = e - w_c T (psi+ + psi)/2. With it the low-pass has the lag of the continuous one.
static int32_t leaked(int32_t flux, int32_t emf, int32_t half_q30, int32_t keep_q30) {
  return q_add_sat(flux, q_mul_sat(q_sub_sat(emf, q_mul(flux, half_q30, 29)), keep_q30, 30));
}

static void leak(ab_t* flux, ab_t emf, int32_t half_q30, int32_t keep_q30) {
  flux->alpha = leaked(flux->alpha, emf.alpha, half_q30, keep_q30);
  flux->beta = leaked(flux->beta, emf.beta, half_q30, keep_q30);
}

// A unit vector that turns by r has the EMF r - 1; in its own frame that is 1 behind the turn and -1 before it.
static void step_bare(stator_flux_t* s, const stator_flux_config_t* c, ab_t emf_q16, int32_t speed_bpp) {
  static const ab_t before_q28 = {-ONE_Q28, 0};
  const int32_t half_q30 = q_shr(c->cutoff_q30, 1);
  const int32_t keep_q30 = ONE_Q30 - half_q30 + q_mul(half_q30, half_q30, 30);  // 1 / (1 + x/2) within 2e-5
  leak(&s->shown_q28, before_q28, half_q30, keep_q30);
  const rotation_t r = frame_rotation((uint32_t)speed_bpp);
  const ab_t was = s->shown_q28;  // turned back with rounding: what is cut off adds up to 1/(w_c T)
  s->shown_q28.alpha = q_add_sat(q_mul_add_sat(was.alpha, r.cos_q30, was.beta, r.sin_q30, 30), q_shr(keep_q30, 2));
  s->shown_q28.beta = q_mul_sub_sat(was.beta, r.cos_q30, was.alpha, r.sin_q30, 30);
  leak(&s->flux_q16, emf_q16, half_q30, keep_q30);
}

// Over a whole period (e . psi)/|psi| is the change of the length by the EMF: taken as that it is exact at any speed,
// where the product with the flux before or behind would show half the square of the angle turned.
static void step_compensated(stator_flux_t* s, const stator_flux_config_t* c, ab_t emf_q16) {
  const ab_t moved = {q_add_sat(s->flux_q16.alpha, emf_q16.alpha), q_add_sat(s->flux_q16.beta, emf_q16.beta)};
  const int32_t length = length_of(moved);
  s->compensation_q16 = q_add_sat(s->compensation_q16, q_mul(q_sub_sat(length, s->length_q16), c->follow_q30, 30));
  const int32_t excess = q_mul_sat(q_sub_sat(length, s->compensation_q16), c->cutoff_q30, 30);
  const int32_t shrink_q30 = q_div(excess, length, 30);
  s->flux_q16.alpha = q_mul_sub_sat(moved.alpha, ONE_Q30, moved.alpha, shrink_q30, 30);
  s->flux_q16.beta = q_mul_sub_sat(moved.beta, ONE_Q30, moved.beta, shrink_q30, 30);
  s->length_q16 = q_sub_sat(length, excess);
}

// A flux that large is none, and clamped it would stay (see the header). From nothing it finds back: the bare one at
// once, as the unit vector begins from nothing as well.
static void restart_beyond(stator_flux_t* s, int32_t bound_q16) {
  static const ab_t none = {0, 0};
  if (q_abs_sat(s->flux_q16.alpha) <= bound_q16 && q_abs_sat(s->flux_q16.beta) <= bound_q16) return;
  s->flux_q16 = none;
  s->shown_q28 = none;
  s->length_q16 = 0;
  s->compensation_q16 = q_shr(bound_q16, 3);
}

void stator_flux_step(stator_flux_t* s, const stator_flux_config_t* c, ab_t emf_q16, int32_t speed_bpp,
                      int32_t bound_q16) {
  if (c->form == STATOR_FLUX_COMPENSATED) {
    step_compensated(s, c, emf_q16);
  } else {
    step_bare(s, c, emf_q16, speed_bpp);
  }
  restart_beyond(s, bound_q16);
}

// Over what the low-pass shows of the flux its output is the flux.
ab_t stator_flux_q16(const stator_flux_t* s, const stator_flux_config_t* c) {
  if (c->form != STATOR_FLUX_BARE) return s->flux_q16;
  const ab_t shown = {q_limit(s->shown_q28.alpha, 2 * ONE_Q28), q_limit(s->shown_q28.beta, 2 * ONE_Q28)};
  const int32_t square_q28 = q_mul_add_sat(shown.alpha, shown.alpha, shown.beta, shown.beta, 28);
  const q_inverse_t per_square = q_invert(q_max(square_q28, LEAST_SQUARE_Q28));
  const int32_t along_q24 = q_limit(q_over(shown.alpha, per_square, 24), SHARE_END_Q24);
  const int32_t across_q24 = q_limit(q_over(shown.beta, per_square, 24), SHARE_END_Q24);
  const ab_t psi = {q_mul_add_sat(s->flux_q16.alpha, along_q24, s->flux_q16.beta, across_q24, 24),
                    q_mul_sub_sat(s->flux_q16.beta, along_q24, s->flux_q16.alpha, across_q24, 24)};
  return psi;
}

#include "estimators/stator_flux.h"

#define ONE_Q30 ((int32_t)1073741824L)
#define ONE_Q24 ((int32_t)16777216L)
#define CUTOFF_LEAST_Q30 107374L
#define CUTOFF_MOST_Q30 53687091L
#define FOLLOW_LEAST_Q30 53687091L
#define FOLLOW_MOST_Q30 1020054733L

bool stator_flux_config_valid(const stator_flux_config_t* c) {
  return q_in_range(c->cutoff_q30, CUTOFF_LEAST_Q30, CUTOFF_MOST_Q30) &&
         q_in_range(c->follow_q30, FOLLOW_LEAST_Q30, FOLLOW_MOST_Q30) && c->form <= STATOR_FLUX_BARE;
}

// w_c/w with its sign, limited; 0 rad per period counts as forwards.
static int32_t lag_q24(const stator_flux_config_t* c, int32_t w_q30) {
  const int32_t most = STATOR_FLUX_LAG_MAX * ONE_Q24;
  return q_clamp(q_div(c->cutoff_q30, w_q30, 24), -most, most);
}

static int32_t length_of(ab_t v) { return q_hypot(v.alpha, v.beta); }

// psi (1 + j k) / (1 + k^2): what the low-pass shows of the flux.
static ab_t attenuated(ab_t psi, int32_t k_q24) {
  const q_inverse_t per_square = q_invert(ONE_Q24 + q_mul(k_q24, k_q24, 24));
  const int32_t along_q24 = q_over(ONE_Q24, per_square, 24);
  const int32_t across_q24 = q_over(k_q24, per_square, 24);
  const ab_t seen = {q_mul_sub_sat(psi.alpha, along_q24, psi.beta, across_q24, 24),
                     q_mul_add_sat(psi.beta, along_q24, psi.alpha, across_q24, 24)};
  return seen;
}

void stator_flux_preset(stator_flux_t* s, const stator_flux_config_t* c, ab_t flux_q16, int32_t w_q30) {
  s->flux_q16 = (c->form == STATOR_FLUX_BARE) ? attenuated(flux_q16, lag_q24(c, w_q30)) : flux_q16;
  s->length_q16 = length_of(s->flux_q16);
  s->compensation_q16 = s->length_q16;
}

// The trapezoidal rule: psi+ - psi = e - w_c T (psi+ + psi)/2. With it the low-pass has the lag of the continuous one.
static int32_t leaked(int32_t flux_q16, int32_t emf_q16, int32_t half_q30, int32_t keep_q30) {
  return q_add_sat(flux_q16, q_mul_sat(q_sub_sat(emf_q16, q_mul(flux_q16, half_q30, 29)), keep_q30, 30));
}

static void step_bare(stator_flux_t* s, const stator_flux_config_t* c, ab_t emf_q16) {
  const int32_t half_q30 = c->cutoff_q30 / 2;
  const int32_t keep_q30 = ONE_Q30 - half_q30 + q_mul(half_q30, half_q30, 30);  // 1 / (1 + x/2) within 2e-5
  s->flux_q16.alpha = leaked(s->flux_q16.alpha, emf_q16.alpha, half_q30, keep_q30);
  s->flux_q16.beta = leaked(s->flux_q16.beta, emf_q16.beta, half_q30, keep_q30);
}

// Over a whole period (e . psi)/|psi| is the change of the length by the EMF: taken as that it is exact at any speed,
// where the product with the flux before or behind would show half the square of the angle turned.
static void step_compensated(stator_flux_t* s, const stator_flux_config_t* c, ab_t emf_q16) {
  const ab_t moved = {q_add_sat(s->flux_q16.alpha, emf_q16.alpha), q_add_sat(s->flux_q16.beta, emf_q16.beta)};
  const int32_t length = length_of(moved);
  s->compensation_q16 = q_add_sat(s->compensation_q16, q_mul(length - s->length_q16, c->follow_q30, 30));
  const int32_t excess = q_mul_sat(q_sub_sat(length, s->compensation_q16), c->cutoff_q30, 30);
  const int32_t shrink_q30 = q_div(excess, length, 30);
  s->flux_q16.alpha = moved.alpha - q_mul_sat(moved.alpha, shrink_q30, 30);
  s->flux_q16.beta = moved.beta - q_mul_sat(moved.beta, shrink_q30, 30);
  s->length_q16 = length - excess;
}

// A flux that large is none, and clamped it would stay (see the header). From nothing it finds back.
static void restart_beyond(stator_flux_t* s, int32_t bound_q16) {
  static const ab_t none = {0, 0};
  if (q_abs_sat(s->flux_q16.alpha) <= bound_q16 && q_abs_sat(s->flux_q16.beta) <= bound_q16) return;
  s->flux_q16 = none;
  s->length_q16 = 0;
  s->compensation_q16 = bound_q16 / 8;
}

void stator_flux_step(stator_flux_t* s, const stator_flux_config_t* c, ab_t emf_q16, int32_t bound_q16) {
  if (c->form == STATOR_FLUX_BARE) {
    step_bare(s, c, emf_q16);
  } else {
    step_compensated(s, c, emf_q16);
  }
  restart_beyond(s, bound_q16);
}

ab_t stator_flux_q16(const stator_flux_t* s, const stator_flux_config_t* c, int32_t w_q30) {
  if (c->form != STATOR_FLUX_BARE) return s->flux_q16;
  const int32_t k_q24 = lag_q24(c, w_q30);
  const ab_t psi = {q_add_sat(s->flux_q16.alpha, q_mul_sat(s->flux_q16.beta, k_q24, 24)),
                    q_sub_sat(s->flux_q16.beta, q_mul_sat(s->flux_q16.alpha, k_q24, 24))};
  return psi;
}

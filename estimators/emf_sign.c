#include "estimators/emf_sign.h"

#define EMF_MIN_Q16 655360L  // 10 V
#define FILTER_SHIFT 5
#define PERIODS 50u

void emf_sign_reset(emf_sign_t* s) {
  const emf_sign_t fresh = {0, 0, 0, 0, 0};
  *s = fresh;
}

static int32_t emf_q16(emf_sign_t* s, const machine_model_t* m, dq_t v_q16, dq_t i_q20, int32_t w_q30) {
  const int32_t change_q20 = i_q20.q - s->last_iq_q20;
  s->last_iq_q20 = i_q20.q;
  // psi / T of the d-axis current, V per (rad per period).
  const int32_t flux_q16 = q_over(i_q20.d, q_invert(m->yd_q30), 26);
  const int32_t drops_q16 = q_add_sat(q_mul(m->rs_q24, i_q20.q, 28), q_over(change_q20, m->per_yq, 26));
  return q_sub_sat(q_sub_sat(v_q16.q, drops_q16), q_mul_sat(flux_q16, w_q30, 30));
}

emf_sign_result_t emf_sign_step(emf_sign_t* s, const machine_model_t* m, dq_t voltage_q16, dq_t current_q20,
                                int32_t speed_bpp) {
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  const int32_t e_q16 = emf_q16(s, m, voltage_q16, current_q20, w_q30);
  const int32_t seen_q16 = (w_q30 < 0) ? q_neg_sat(e_q16) : e_q16;
  s->seen_q16 += q_shr_round(q_sub_sat(seen_q16, s->seen_q16), FILTER_SHIFT);
  s->expected_q16 += q_shr_round(q_mul_sat(m->emf_q16, q_abs_sat(w_q30), 30) - s->expected_q16, FILTER_SHIFT);
  const bool large = s->expected_q16 > EMF_MIN_Q16;
  s->clear = (large && s->seen_q16 > s->expected_q16 / 2) ? (uint16_t)(s->clear + 1u) : 0u;
  s->against = (large && s->seen_q16 < -s->expected_q16 / 4) ? (uint16_t)(s->against + 1u) : 0u;
  if (s->against > PERIODS) return EMF_SIGN_REVERSED;
  return (s->clear > PERIODS) ? EMF_SIGN_RIGHT : EMF_SIGN_OPEN;
}

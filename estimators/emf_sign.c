#include "estimators/emf_sign.h"

#include "hal/qmath/qcall.h"

#define EMF_MIN_Q16 655360L  // 10 V
#define FILTER_SHIFT 5u
#define PERIODS 50u

void emf_sign_reset(emf_sign_t* s) {
  const emf_sign_t fresh = {0, 0, 0, 0, 0};
  *s = fresh;
}

static int32_t emf_q16(emf_sign_t* s, const machine_model_t* m, const emf_sign_seen_t* seen, int32_t w_q30) {
  const int32_t change_q20 = (seen->current_q20.q - s->last_iq_q20) / seen->periods;
  s->last_iq_q20 = seen->current_q20.q;
  // psi / T of the d-axis current, V per (rad per period).
  const int32_t flux_q16 = qc_over(seen->current_q20.d, q_invert(m->yd_q30), 26);
  const int32_t drops_q16 = qc_add_sat(qc_mul(m->rs_q24, seen->current_q20.q, 28), qc_over(change_q20, m->per_yq, 26));
  return qc_sub_sat(qc_sub_sat(seen->voltage_q16.q, drops_q16), qc_mul_sat(flux_q16, w_q30, 30));
}

// The power of two next to 32 periods.
static unsigned shift_of(int32_t periods) { return (periods < 4) ? FILTER_SHIFT : FILTER_SHIFT - 3u; }

emf_sign_result_t emf_sign_step(emf_sign_t* s, const machine_model_t* m, const emf_sign_seen_t* seen) {
  const int32_t w_q30 = machine_speed_rad_q30(seen->speed_bpp);
  const int32_t e_q16 = emf_q16(s, m, seen, w_q30);
  const int32_t seen_q16 = (w_q30 < 0) ? q_neg_sat(e_q16) : e_q16;
  const unsigned shift = shift_of(seen->periods);
  const uint16_t periods = (uint16_t)seen->periods;
  s->seen_q16 = q_follow(s->seen_q16, seen_q16, shift);
  s->expected_q16 = q_follow(s->expected_q16, qc_mul_sat(m->emf_q16, qc_abs_sat(w_q30), 30), shift);
  const bool large = s->expected_q16 > EMF_MIN_Q16;
  s->clear = (large && s->seen_q16 > s->expected_q16 / 2) ? (uint16_t)(s->clear + periods) : 0u;
  s->against = (large && s->seen_q16 < -(s->expected_q16 / 4)) ? (uint16_t)(s->against + periods) : 0u;
  if (s->against > PERIODS) return EMF_SIGN_REVERSED;
  return (s->clear > PERIODS) ? EMF_SIGN_RIGHT : EMF_SIGN_OPEN;
}

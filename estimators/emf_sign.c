#include "estimators/emf_sign.h"

#include "hal/qmath/qcall.h"

#define EMF_MIN_Q16 655360L  // 10 V
#define FILTER_SHIFT 2u
#define PERIODS 50
#define LATE 32  // a look that was late counts as one of 32 periods: the sign has to be seen twice

void emf_sign_reset(emf_sign_t* s) {
  const emf_sign_t fresh = {0, 0, 0, 0, 0, 0};
  *s = fresh;
}

void emf_sign_look(emf_sign_t* s, const machine_model_t* m, const emf_sign_seen_t* seen) {
  const int32_t change_q20 = (seen->current_q20.q - s->last_iq_q20) / seen->periods;
  s->last_iq_q20 = seen->current_q20.q;
  // psi / T of the d-axis current, V per (rad per period).
  const int32_t flux_q16 = qc_mul_sat(seen->current_q20.d, m->ld_q16, 20);
  const int32_t drops_q16 = qc_add_sat(qc_mul(m->rs_q24, seen->current_q20.q, 28), qc_over(change_q20, m->per_yq, 26));
  const int32_t of_flux_q16 = qc_mul_sat(flux_q16, machine_speed_rad_q30(seen->speed_bpp), 30);
  s->emf_q16 = qc_sub_sat(qc_sub_sat(seen->voltage_q_q16, drops_q16), of_flux_q16);
  s->periods = (int16_t)q_min(seen->periods, LATE);
}

emf_sign_result_t emf_sign_judge(emf_sign_t* s, const machine_model_t* m, int32_t speed_bpp) {
  const int32_t periods = s->periods;
  if (periods == 0) return EMF_SIGN_OPEN;
  s->periods = 0;
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  const int32_t seen_q16 = (w_q30 < 0) ? q_neg_sat(s->emf_q16) : s->emf_q16;
  s->seen_q16 = q_follow_halves(s->seen_q16, seen_q16, FILTER_SHIFT);
  s->expected_q16 = q_follow_near(s->expected_q16, qc_mul_sat(m->emf_q16, qc_abs_sat(w_q30), 30), FILTER_SHIFT);
  int32_t agreed = 0;
  if (s->expected_q16 > EMF_MIN_Q16) {
    if (s->seen_q16 > s->expected_q16 / 2) agreed = q_max(s->agreed, 0) + periods;
    if (s->seen_q16 < -(s->expected_q16 / 4)) agreed = q_min(s->agreed, 0) - periods;
  }
  s->agreed = (int16_t)agreed;
  if (agreed < -PERIODS) return EMF_SIGN_REVERSED;
  return (agreed > PERIODS) ? EMF_SIGN_RIGHT : EMF_SIGN_OPEN;
}

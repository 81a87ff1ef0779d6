#include "control/mtpa.h"

#include "hal/qmath/qcall.h"

#define POLE_MAX_Q20 1048576000L  // 1000 A
#define CURRENT_MAX_Q20 209715200L

void mtpa_design(mtpa_t* s, const machine_model_t* m) {
  // lambda Q28 over 2 (Lq - Ld) Q30, to Q20: 2^21 of the quotient of the raw numbers. Without saliency it is infinite.
  const int32_t pole_q20 = q_div(m->flux_q28, m->lq_q30 - m->ld_q30, 21);
  s->pole_q20 = (pole_q20 <= POLE_MAX_Q20) ? pole_q20 : 0;
}

int32_t mtpa_current_q20(const mtpa_t* s, int32_t iq_q20) {
  if (s->pole_q20 == 0) return 0;
  const int32_t iq = q_min(q_abs_sat(iq_q20), CURRENT_MAX_Q20);
  const int64_t square = (int64_t)s->pole_q20 * s->pole_q20 + (int64_t)iq * iq;
  const int32_t root = (int32_t)q_sqrt64((uint64_t)square);
  const q_inverse_t per_sum = q_invert(q_add_sat(s->pole_q20, root));
  return -q_mul(qc_over(iq, per_sum, 30), iq, 30);
}

#include "estimators/voltage_match.h"

#define CURRENT_UNIT_SHIFT 2u  // 4 A count as much
#define SPEED_UNITS 50L        // as 1/50 rad per period, 480 rpm with four pole pairs
#define FLOOR_Q16 4096L        // (a quarter of a unit)^2: less current and speed than that tell nothing

void voltage_match_step(machine_model_t* m, const regression_t* r, int32_t w_q30, int32_t share_q30) {
  machine_trim_t* const t = &m->trim;
  // Current and speed in their units, Q16.
  const int32_t i_q16 = q_shr(r->current_q20.q, 4u + CURRENT_UNIT_SHIFT);
  const int32_t w_q16 = q_mul(w_q30, SPEED_UNITS * 65536L, 30);
  const int32_t still_q16 = q_add_sat(q_mul_sat(i_q16, i_q16, 16), FLOOR_Q16);
  const int32_t power_q16 = q_add_sat(still_q16, q_mul_sat(w_q16, w_q16, 16));
  const int32_t e_q16 = q_over(r->mean_q20.q, m->per_yq, 26);  // V
  const q_inverse_t per_power = q_invert(power_q16);
  const int32_t step_q22 = q_mul_sat(q_over(e_q16, per_power, 16), share_q30, 24);
  // What the back-EMF leaves at speed is not the resistance's: it learns with its part of the power only.
  const int32_t slow_q22 = q_mul(step_q22, q_over(still_q16, per_power, 30), 30);
  t->rs_q24 -= q_mul_sat(slow_q22, i_q16, 16);  // a volt is 1/4 ohm
  t->psi_q16 -= q_mul_sat(q_mul_sat(step_q22, w_q16, 16), SPEED_UNITS, 6);
  t->rs_q24 = q_clamp(t->rs_q24, -m->nominal_rs_q24 / 2, m->nominal_rs_q24);
  t->psi_q16 = q_clamp(t->psi_q16, -m->emf_q16 / 4, m->emf_q16 / 4);
}

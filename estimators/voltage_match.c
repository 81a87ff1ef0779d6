#include "estimators/voltage_match.h"

#define CURRENT_UNIT_SHIFT 2u  // 4 A count as much
#define SPEED_UNITS 50L        // as 1/50 rad per period, 480 rpm with four pole pairs
#define SPEED_UNITS_Q8 (SPEED_UNITS * 256L)
#define HASTE_MIN_Q16 21845L  // a third of that speed, 160 rpm
#define HASTE_OVER 8          // the haste is over at eight times the share
#define FLOOR_Q16 4096L       // (a quarter of a unit)^2: less current and speed than that tell nothing

// The flux told may be far off: at first its error is taken over as by a mean of all steps, 1/n, with n beginning where
// the haste does; 1/(n + 1) is 1/n - 1/n^2. The resistance waits. Only with speed is there anything to count.
static bool hurry(machine_model_t* m, int32_t e_q16, int32_t w_q16, int32_t share_q30) {
  machine_trim_t* const t = &m->trim;
  const int32_t speed_q16 = q_abs_sat(w_q16);
  if (speed_q16 < HASTE_MIN_Q16 || t->psi_haste_q30 / HASTE_OVER <= share_q30) return false;
  const int32_t along_q16 = (w_q16 < 0) ? q_neg_sat(e_q16) : e_q16;
  const int32_t error_q16 = q_mul_sat(q_over(along_q16, q_invert(speed_q16), 16), SPEED_UNITS_Q8, 8);
  t->psi_q16 = q_sub_sat(t->psi_q16, q_mul(error_q16, t->psi_haste_q30, 30));
  t->psi_haste_q30 -= q_mul(t->psi_haste_q30, t->psi_haste_q30, 30);
  return true;
}

static void bound(machine_model_t* m) {
  machine_trim_t* const t = &m->trim;
  t->rs_q24 = q_clamp(t->rs_q24, -m->nominal_rs_q24 / 2, m->nominal_rs_q24);
  t->psi_q16 = q_clamp(t->psi_q16, -m->emf_q16 / 8 * 3, m->emf_q16 / 8 * 3);
}

void voltage_match_resistance(machine_model_t* m, int32_t more_q24) {
  m->trim.rs_q24 = q_add_sat(m->trim.rs_q24, more_q24);
  bound(m);
}

void voltage_match_step(machine_model_t* m, const regression_t* r, int32_t w_q30, int32_t share_q30) {
  machine_trim_t* const t = &m->trim;
  if (share_q30 == 0) return;
  // Current and speed in their units, Q16.
  const int32_t i_q16 = q_shr(m->iq_q20, 4u + CURRENT_UNIT_SHIFT);
  const int32_t w_q16 = q_mul(w_q30, SPEED_UNITS * 65536L, 30);
  const int32_t e_q16 = q_over(r->mean_q20.q, m->per_yq, 26);  // V
  if (!hurry(m, e_q16, w_q16, share_q30)) {
    const int32_t still_q16 = q_add_sat(q_mul_sat(i_q16, i_q16, 16), FLOOR_Q16);
    const int32_t power_q16 = q_add_sat(still_q16, q_mul_sat(w_q16, w_q16, 16));
    const q_inverse_t per_power = q_invert(power_q16);
    const int32_t step_q22 = q_mul_sat(q_over(e_q16, per_power, 16), share_q30, 24);
    // What the back-EMF leaves at speed is not the resistance's: it learns with its part of the power only.
    const int32_t slow_q22 = q_mul(step_q22, q_over(still_q16, per_power, 30), 30);
    t->rs_q24 = q_sub_sat(t->rs_q24, q_mul_sat(slow_q22, i_q16, 16));  // a volt is 1/4 ohm
    t->psi_q16 = q_sub_sat(t->psi_q16, q_mul_sat(q_mul_sat(step_q22, w_q16, 16), SPEED_UNITS, 6));
  }
  bound(m);
}

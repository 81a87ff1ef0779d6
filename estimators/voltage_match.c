#include "estimators/voltage_match.h"

#include "hal/qmath/qcall.h"

#define CURRENT_UNIT_SHIFT 2u  // 4 A count as much
#define SPEED_UNITS 50L        // as 1/50 rad per period, 480 rpm with four pole pairs
#define HASTE_MIN_Q16 7282L    // (a third of it)^2, 160 rpm
#define ONE_Q20 1048576L
#define HASTE_OVER 8     // the haste is over at eight times the share
#define FLOOR_Q16 4096L  // (a quarter of a unit)^2: less current and speed than that tell nothing

// The nominal flux may be far off. While that is so its error is taken over by least squares: the slower it turns, the
// less a voltage tells of the flux, so what is known already counts with its speed squared. True where a step is due to
// that and not to the drift.
static bool hurries(machine_trim_t* t, int32_t speed_squared_q16, int32_t share_q30) {
  const int32_t known_q20 = qc_mul_sat(t->psi_variance_q32, speed_squared_q16, 28);
  if (speed_squared_q16 < HASTE_MIN_Q16 || known_q20 / HASTE_OVER <= q_shr(share_q30, 10)) return false;
  t->psi_variance_q32 = qc_over(t->psi_variance_q32, q_invert(ONE_Q20 + known_q20), 20);
  return true;
}

static void bound_resistance(machine_model_t* m) {
  m->trim.rs_q24 = q_clamp(m->trim.rs_q24, -m->nominal_rs_q24 / 2, m->nominal_rs_q24);
}

static void bound(machine_model_t* m) {
  machine_trim_t* const t = &m->trim;
  bound_resistance(m);
  t->psi_q16 = q_clamp(t->psi_q16, -m->emf_q16 / 8 * 3, m->emf_q16 / 8 * 3);
}

void voltage_match_resistance(machine_model_t* m, int32_t more_q24) {
  m->trim.rs_q24 = qc_add_sat(m->trim.rs_q24, more_q24);
  bound_resistance(m);
}

void voltage_match_step(machine_model_t* m, const regression_t* r, int32_t w_q30, int32_t share_q30) {
  machine_trim_t* const t = &m->trim;
  if (share_q30 == 0) return;
  // Current and speed in their units, Q16.
  const int32_t i_q16 = q_shr(m->iq_q20, 4u + CURRENT_UNIT_SHIFT);
  const int32_t w_q16 = qc_mul(w_q30, SPEED_UNITS * 65536L, 30);
  const int32_t e_q16 = qc_over(r->mean_q20.q, m->per_yq, 26);  // V
  const int32_t speed_squared_q16 = qc_mul_sat(w_q16, w_q16, 16);
  int32_t step_q22 = 0;
  if (hurries(t, speed_squared_q16, share_q30)) {
    step_q22 = qc_mul_sat(e_q16, t->psi_variance_q32, 26);
  } else {
    const int32_t still_q16 = qc_add_sat(qc_mul_sat(i_q16, i_q16, 16), FLOOR_Q16);
    const q_inverse_t per_power = q_invert(qc_add_sat(still_q16, speed_squared_q16));
    step_q22 = qc_mul_sat(qc_over(e_q16, per_power, 16), share_q30, 24);
    // What the back-EMF leaves at speed is not the resistance's: it learns with its part of the power only.
    const int32_t slow_q22 = qc_mul(step_q22, qc_over(still_q16, per_power, 30), 30);
    t->rs_q24 = qc_sub_sat(t->rs_q24, qc_mul_sat(slow_q22, i_q16, 16));  // a volt is 1/4 ohm
  }
  t->psi_q16 = qc_sub_sat(t->psi_q16, qc_mul_sat(qc_mul_sat(step_q22, w_q16, 16), SPEED_UNITS, 6));
  bound(m);
}

#include "estimators/deviation.h"

// Voltage left for the inductance, V Q16.
static dq_t inductive_voltage(const machine_model_t* m, dq_t v_q16, dq_t i_q20) {
  const dq_t u = {v_q16.d - q_mul(m->rs_q24, i_q20.d, 28), v_q16.q - q_mul(m->rs_q24, i_q20.q, 28)};
  return u;
}

deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp) {
  const rotation_t r = frame_rotation(deviation_angle_at(angle_bam, speed_bpp, w->middle_tick));
  const dq_t slope_q20 = frame_park(w->slope_q20, r);
  deviation_t d;
  d.voltage_q16 = frame_park(w->voltage_q16, r);
  d.current_q20 = frame_park(w->current_q20, r);
  d.w_q30 = machine_speed_rad_q30(speed_bpp);
  dq_t u_q16 = inductive_voltage(m, d.voltage_q16, d.current_q20);
  u_q16.q -= q_mul(m->emf_q16, d.w_q30, 30);
  const int32_t turn_d = q_mul(q_mul(m->kappa_d_q24, d.current_q20.q, 24), d.w_q30, 30);
  const int32_t turn_q = q_mul(q_mul(m->kappa_q_q24, d.current_q20.d, 24), d.w_q30, 30);
  d.residual_q20.d = slope_q20.d - q_mul(m->yd_q30, u_q16.d, 26) - turn_d;
  d.residual_q20.q = slope_q20.q - q_mul(m->yq_q30, u_q16.q, 26) - turn_q;
  return d;
}

dq_t deviation_angle_sensitivity(const machine_model_t* m, const deviation_t* d) {
  const dq_t u_q16 = inductive_voltage(m, d->voltage_q16, d->current_q20);
  const int32_t dy_q30 = m->yd_q30 - m->yq_q30;
  const int32_t kappa_q24 = m->kappa_d_q24 + m->kappa_q_q24;
  const int32_t emf_q20 = q_mul(m->yq_q30, m->emf_q16, 26) - q_mul(kappa_q24, d->current_q20.d, 24);
  const dq_t h = {q_mul(dy_q30, u_q16.q, 26) + q_mul(emf_q20, d->w_q30, 30),
                  q_mul(dy_q30, u_q16.d, 26) + q_mul(q_mul(kappa_q24, d->current_q20.q, 24), d->w_q30, 30)};
  return h;
}

dq_t deviation_speed_sensitivity(const machine_model_t* m, const deviation_t* d) {
  const dq_t h = {q_mul(m->kappa_d_q24, d->current_q20.q, 24),
                  q_mul(m->kappa_q_q24, d->current_q20.d, 24) - q_mul(m->yq_q30, m->emf_q16, 26)};
  return h;
}

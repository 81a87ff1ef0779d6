#include "estimators/deviation.h"

deviation_t deviation_in_frame(const machine_model_t* m, const estimator_window_t* w, const estimator_frame_t* f,
                               int32_t w_q30) {
  const dq_t slope_q20 = frame_park(w->slope_q20, f->rotation);
  deviation_t d;
  d.voltage_q16 = frame_park(w->voltage_q16, f->rotation);
  d.current_q20 = f->current_q20;
  d.w_q30 = w_q30;
  d.drive_q16.d = d.voltage_q16.d - q_mul_floor(m->rs_q24, d.current_q20.d, 28);
  d.drive_q16.q = d.voltage_q16.q - q_mul_floor(m->rs_q24, d.current_q20.q, 28);
  d.turn_q20 = machine_turn_q20(m, d.current_q20);
  const dq_t admitted = machine_admit_q20(m, d.drive_q16);
  d.residual_q20.d = slope_q20.d - admitted.d - q_mul_floor(d.turn_q20.d, d.w_q30, 30);
  d.residual_q20.q = slope_q20.q - admitted.q - q_mul_floor(d.turn_q20.q, d.w_q30, 30);
  return d;
}

deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp) {
  const estimator_frame_t f = deviation_frame(w, deviation_angle_at(angle_bam, speed_bpp, w->middle_tick));
  return deviation_in_frame(m, w, &f, machine_speed_rad_q30(speed_bpp));
}

dq_t deviation_angle_sensitivity(const machine_model_t* m, const deviation_t* d) {
  const int32_t saliency_q30 = m->yd_q30 - m->yq_q30;
  const int32_t tilt_q30 = 2 * m->ydq_q30;
  // J K - K J = [-p, q; q, p] with p = K_dq + K_qd, q = 2 K_dd; J k0 = (-k0_q, k0_d).
  const int32_t p_q24 = m->k_dq_q24 + m->k_qd_q24;
  const int32_t q_q24 = 2 * m->k_dd_q24;
  const dq_t i = d->current_q20;
  const int32_t turn_d = q_mul_sub_floor(q_q24, i.q, p_q24, i.d, 24) - m->k0_q20.q;
  const int32_t turn_q = q_mul_add_floor(q_q24, i.d, p_q24, i.q, 24) + m->k0_q20.d;
  const dq_t u = d->drive_q16;
  const dq_t h = {q_mul_sub_floor(saliency_q30, u.q, tilt_q30, u.d, 26) + q_mul_floor(turn_d, d->w_q30, 30),
                  q_mul_add_floor(saliency_q30, u.d, tilt_q30, u.q, 26) + q_mul_floor(turn_q, d->w_q30, 30)};
  return h;
}

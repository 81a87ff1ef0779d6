#include "estimators/deviation.h"

#define PER_TICK_Q32 429496L    // 1 / ESTIMATOR_PERIOD_TICKS, rounded down: half a period of ticks stays in 31 bits
#define LOST_MAX_Q16 98304000L  // 1500 V over the resistance: more the samples alone can say
#define ONE_SIXTH_Q32 715827883L
#define ONE_TWELFTH_Q32 357913941L

// A rotation turned on by an angle below 1 rad: 1 - cos x = x^2/2 (1 - x^2/12), sin x = x (1 - x^2/6).
static rotation_t turned(rotation_t r, int32_t x_q30) {
  const int32_t square_q28 = q_mul_hi(x_q30, x_q30);
  const int32_t fourth_q28 = q_mul_hi(square_q28 * 4, q_mul_hi(square_q28 * 4, ONE_TWELFTH_Q32));
  const int32_t versine_q30 = (square_q28 - fourth_q28) * 2;
  const int32_t sine_q30 = x_q30 - q_mul_hi(q_mul_hi(x_q30, square_q28) * 16, ONE_SIXTH_Q32);
  const int32_t sine_step_q28 = q_mul_add_floor(r.cos_q30, sine_q30, r.sin_q30, -versine_q30, 32);
  const int32_t cosine_step_q28 = q_mul_add_floor(r.sin_q30, sine_q30, r.cos_q30, versine_q30, 32);
  const rotation_t next = {r.sin_q30 + sine_step_q28 * 4, r.cos_q30 - cosine_step_q28 * 4};
  return next;
}

void deviation_frames(const estimator_window_t windows[], uint16_t count, uint32_t middle_bam, int32_t w_q30,
                      estimator_frame_t frames[]) {
  const rotation_t middle = frame_rotation(middle_bam);
  for (uint16_t k = 0; k < count; k++) {
    const int32_t after_q32 = (windows[k].middle_tick - ESTIMATOR_PERIOD_TICKS / 2) * PER_TICK_Q32;
    frames[k].rotation = turned(middle, q_mul_hi(w_q30, after_q32));
    frames[k].current_q20 = frame_park(windows[k].current_q20, frames[k].rotation);
  }
}

// No saturation: the model keeps Y below 2, R below 100 and K below 125 (machine_model.h), and w below 1.9, so that A
// is below 512.
deviation_model_t deviation_model(const machine_model_t* m, int32_t w_q30) {
  deviation_model_t at;
  const int32_t turn_dd_q22 = q_mul_hi(w_q30, m->k_dd_q24);
  const int32_t y_dd_q26 = q_shr(m->yd_q30, 4);
  const int32_t y_dq_q26 = q_shr(m->ydq_q30, 4);
  const int32_t y_qq_q26 = q_shr(m->yq_q30, 4);
  const int32_t cross_q22 = q_mul_floor(y_dq_q26, m->rs_q24, 28);
  at.less_dd_q26 = -y_dd_q26;
  at.less_dq_q26 = -y_dq_q26;
  at.less_qq_q26 = -y_qq_q26;
  at.a_dd_q22 = q_mul_floor(y_dd_q26, m->rs_q24, 28) - turn_dd_q22;
  at.a_dq_q22 = cross_q22 - q_mul_hi(w_q30, m->k_dq_q24);
  at.a_qd_q22 = cross_q22 - q_mul_hi(w_q30, m->k_qd_q24);
  at.a_qq_q22 = q_mul_floor(y_qq_q26, m->rs_q24, 28) + turn_dd_q22;
  at.less_emf_q42.d = q_shr64(q_product(-w_q30, m->k0_q20.d), 8);
  at.less_emf_q42.q = q_shr64(q_product(-w_q30, m->k0_q20.q), 8);
  return at;
}

deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp) {
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  const deviation_model_t at = deviation_model(m, w_q30);
  estimator_frame_t f;
  deviation_frames(w, 1, deviation_middle(angle_bam, speed_bpp), w_q30, &f);
  deviation_t d;
  deviation_in_frame(&at, w, &f, &d);
  return d;
}

deviation_sensitivity_t deviation_sensitivity(const machine_model_t* m, int32_t w_q30, dq_t i) {
  // J K - K J = [-p, q; q, p] with p = K_dq + K_qd, q = 2 K_dd; J k0 = (-k0_q, k0_d).
  const int32_t p_q24 = q_add_sat(m->k_dq_q24, m->k_qd_q24);
  const int32_t q_q24 = 2 * m->k_dd_q24;
  const dq_t turn = {machine_sensitivity_q20(q_product(q_q24, i.q) - q_product(p_q24, i.d), -(int64_t)m->k0_q20.q),
                     machine_sensitivity_q20(q_mac(q_product(q_q24, i.d), p_q24, i.q), m->k0_q20.d)};
  const dq_t lost_q16 = {q_limit(q_mul_floor(m->rs_q24, i.d, 28), LOST_MAX_Q16),
                         q_limit(q_mul_floor(m->rs_q24, i.q, 28), LOST_MAX_Q16)};
  deviation_sensitivity_t s = {
      m->yd_q30 - m->yq_q30, 2 * m->ydq_q30, -2 * m->ydq_q30, {0, 0}, machine_speed_sensitivity_q20(m, i)};
  const dq_t lost_q17 = deviation_by_angle_q17(&s, lost_q16);
  s.rest_q17.d = q_mul_floor(turn.d, w_q30, 33) - lost_q17.d;
  s.rest_q17.q = q_mul_floor(turn.q, w_q30, 33) - lost_q17.q;
  return s;
}

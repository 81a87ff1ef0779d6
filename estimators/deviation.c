#include "estimators/deviation.h"

#define PER_TICK_Q32 429496L     // 1 / ESTIMATOR_PERIOD_TICKS, rounded down: half a period of ticks stays in 31 bits
#define LOST_MAX_Q17 196608000L  // 1500 V over the resistance: more the samples alone can say
#define REST_BITS 28u            // 2048 A per period and rad, Q17
#define SEGMENT_BITS 12u         // a segment, Q12
#define MORE_BITS 26u            // 1/16 A per V and period: with it h_angle stays in its format

// A rotation turned on by an angle x below 1 rad, to x^3/6: 1 - cos x = x^2/2, sin x = x.
static rotation_t turned(rotation_t r, int32_t x_q30) {
  const int32_t versine_q30 = q_mul_hi(x_q30, x_q30) * 2;
  const rotation_t next = {r.sin_q30 + (q_mul_hi(r.cos_q30, x_q30) - q_mul_hi(r.sin_q30, versine_q30)) * 4,
                           r.cos_q30 - (q_mul_hi(r.sin_q30, x_q30) + q_mul_hi(r.cos_q30, versine_q30)) * 4};
  return next;
}

void deviation_frames(const estimator_window_t windows[], uint16_t count, uint32_t middle_bam, int32_t w_q30,
                      estimator_frame_t frames[]) {
  const rotation_t middle = frame_rotation(middle_bam);
  for (uint16_t k = 0; k < count; k++) {
    const int32_t after_q32 = (windows[k].middle_tick - ESTIMATOR_PERIOD_TICKS / 2) * PER_TICK_Q32;
    frames[k].rotation = turned(middle, q_mul_hi(w_q30, after_q32));
    frames[k].current_q18 = frame_park_hi(windows[k].current_q20, frames[k].rotation);
  }
}

// Element of A = Y R - w K, to 2.4e-7.
static int32_t damping_q29(const machine_model_t* m, int32_t y_q30, int32_t w_q30, int32_t k_q24) {
  return q_within_bits(q_mul_hi(y_q30, m->rs_q24) - q_mul_hi(w_q30, k_q24), DEVIATION_DAMPING_BITS) * 128;
}

deviation_model_t deviation_model(const machine_model_t* m, int32_t w_q30) {
  const deviation_model_t at = {q_shr(m->yd_q30, 1) + q_shr(m->yq_q30, 1),
                                q_shr(m->yd_q30 - m->yq_q30, 1),
                                m->ydq_q30,
                                damping_q29(m, m->yd_q30, w_q30, m->k_dd_q24),
                                damping_q29(m, m->ydq_q30, w_q30, m->k_dq_q24),
                                damping_q29(m, m->ydq_q30, w_q30, m->k_qd_q24),
                                damping_q29(m, m->yq_q30, w_q30, -m->k_dd_q24),
                                {q_shr(q_mul_hi(w_q30, m->k0_q20.d), 3), q_shr(q_mul_hi(w_q30, m->k0_q20.q), 3)},
                                {q_within_bits(m->slope.yqq_q30, MORE_BITS + 1u),  // a mean has half of it
                                 q_within_bits(m->slope.ydq_q30, MORE_BITS)},
                                m->map.per_segment_q26};
  return at;
}

// A change of the current that the model makes of a slope, A, Q17.
static int32_t made_q17(int32_t slope_q15, int32_t share_q30) { return q_mul_floor(slope_q15, share_q30, 28); }

static void change_of(const deviation_model_t* at, const estimator_window_t* w, const estimator_frame_t* f,
                      int32_t iq_q18, deviation_change_t* out) {
  const int32_t share_q30 = estimator_share_q30(w);
  const dq_t v = frame_park_hi(w->voltage_q19, f->rotation);
  const dq_t i = f->current_q18;
  // Of a segment, to 1/4096 of it, and at most one: a larger ripple has left the segment that the slope is of.
  const int32_t off_q12 = q_within_bits(q_mul_hi(i.q - iq_q18, at->per_segment_q26), SEGMENT_BITS);
  const int32_t off_q30 = off_q12 * 262144L;
  const int32_t half_more_q30 = q_mul_hi(at->slope.yqq_q30, off_q30) * 2;  // of yqq
  const int32_t cross_more_q30 = q_mul_hi(at->slope.ydq_q30, off_q30) * 4;
  const int32_t mean_q30 = at->mean_q30 + half_more_q30;
  const dq_t mirrored = deviation_mirrored_q15(at->half_q30 - half_more_q30, at->cross_q30 + cross_more_q30, v);
  const dq_t slope_q15 = {
      q_mul_hi(mean_q30, v.d) + mirrored.d + at->emf_q15.d - q_mul_hi(at->a_dd_q29, i.d) - q_mul_hi(at->a_dq_q29, i.q),
      q_mul_hi(mean_q30, v.q) + mirrored.q + at->emf_q15.q - q_mul_hi(at->a_qd_q29, i.d) - q_mul_hi(at->a_qq_q29, i.q)};
  const dq_t seen_q17 = frame_park_hi(w->change_q19, f->rotation);
  // Two upper words lose a unit together, and a difference of them none.
  out->left_q17.d = seen_q17.d + 1 - made_q17(slope_q15.d, share_q30);
  out->left_q17.q = seen_q17.q - made_q17(slope_q15.q, share_q30);
  out->mirrored_q15 = mirrored;
  out->voltage_q17 = v;
}

void deviation_changes(const deviation_model_t* at, const estimator_window_t windows[],
                       const estimator_frame_t frames[], uint16_t count, int32_t iq_q18, deviation_change_t seen[]) {
  for (uint16_t k = 0; k < count; k++) change_of(at, &windows[k], &frames[k], iq_q18, &seen[k]);
}

dq_t deviation_see(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, deviation_change_t seen[]) {
  estimator_frame_t own[ESTIMATOR_WINDOWS];
  const estimator_frame_t* frames = in->frames;
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  if (frames == 0) {
    deviation_frames(in->windows, in->window_count, deviation_middle(angle_bam, speed_bpp), w_q30, own);
    frames = own;
  }
  const deviation_model_t at = deviation_model(in->model, w_q30);
  deviation_changes(&at, in->windows, frames, in->window_count, q_shr(in->iq_q20, 2), seen);
  return frames[in->window_count / 2u].current_q18;
}

deviation_t deviation_slope(const deviation_change_t* c, int32_t span_ticks) {
  const deviation_t d = {
      {deviation_slope_q20(c->left_q17.d, 17, span_ticks), deviation_slope_q20(c->left_q17.q, 17, span_ticks)},
      {q_shr(c->voltage_q17.d, 1), q_shr(c->voltage_q17.q, 1)}};
  return d;
}

deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp) {
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  deviation_model_t at = deviation_model(m, w_q30);
  estimator_frame_t f;
  deviation_change_t c;
  at.slope.yqq_q30 = 0;
  at.slope.ydq_q30 = 0;
  deviation_frames(w, 1, deviation_middle(angle_bam, speed_bpp), w_q30, &f);
  deviation_changes(&at, w, &f, 1, 0, &c);
  return deviation_slope(&c, w->span_ticks);
}

deviation_sensitivity_t deviation_sensitivity(const machine_model_t* m, int32_t w_q30, dq_t i) {
  // J K - K J = [-p, q; q, p] with p = K_dq + K_qd, q = 2 K_dd; J k0 = (-k0_q, k0_d).
  const int32_t p_q24 = q_add_sat(m->k_dq_q24, m->k_qd_q24);
  const int32_t q_q24 = 2 * m->k_dd_q24;
  const dq_t turn = {machine_sensitivity_q20(q_product(q_q24, i.q) - q_product(p_q24, i.d), -(int64_t)m->k0_q20.q),
                     machine_sensitivity_q20(q_mac(q_product(q_q24, i.d), p_q24, i.q), m->k0_q20.d)};
  const dq_t lost_q17 = {q_limit(q_mul_floor(m->rs_q24, i.d, 27), LOST_MAX_Q17),
                         q_limit(q_mul_floor(m->rs_q24, i.q, 27), LOST_MAX_Q17)};
  const dq_t mirrored_q15 = deviation_mirrored_q15(q_shr(m->yd_q30 - m->yq_q30, 1), m->ydq_q30, lost_q17);
  const deviation_sensitivity_t s = {{q_within_bits(q_mul_floor(turn.d, w_q30, 33) + mirrored_q15.q * 8, REST_BITS),
                                      q_within_bits(q_mul_floor(turn.q, w_q30, 33) - mirrored_q15.d * 8, REST_BITS)},
                                     machine_speed_sensitivity_q20(m, i)};
  return s;
}

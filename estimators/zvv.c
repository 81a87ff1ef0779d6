#include "estimators/zvv.h"

#include "estimators/deviation.h"

#define ERROR_LIMIT_Q24 117127230L  // 400 degrees: what ten periods may add up to
#define LOAD_SHARE_Q30 5368709L     // 1/200: a low-pass of 20 ms
#define INTEGRAL_LIMIT 2000000000L
#define ONE_Q26 67108864L

void zvv_preset(zvv_t* s, uint32_t angle_bam, int32_t speed_bpp, int32_t load_accel_q8) {
  s->angle_bam = angle_bam;
  s->speed_bpp = speed_bpp;
  s->integral_q8bpp = q_shl_sat(speed_bpp, 8);
  s->load_accel_q8 = load_accel_q8;
  s->waited = 0;
}

// What D has of the speed and of the drops.
typedef struct {
  int32_t emf_q16;   // w lambda of the speed that D takes off, V
  int32_t turn_q30;  // w of the rotation's part, rad per period; 0 without it
  bool drops;
} look_t;

// D (22) of a window, A per period.
static int32_t deviation_of_q20(const machine_model_t* m, const estimator_window_t* w, const estimator_frame_t* f,
                                const look_t* look) {
  const dq_t change_q19 = frame_park(w->change_q19, f->rotation);
  int32_t volts_q16 = q_sat64(q_mul64(m->rs_q24, f->current_q18.q, 26) + look->emf_q16);
  if (look->drops) volts_q16 = q_sub_sat(volts_q16, q_shr(frame_park_hi(w->voltage_q19, f->rotation).q, 1));
  const int32_t slope_q20 = deviation_slope_q20(change_q19.q, 19, w->span_ticks);
  const int64_t deviation_q46 = q_mac(q_product(m->yq_q30, volts_q16), slope_q20, ONE_Q26) + ONE_Q26 / 2;
  const int32_t turned_q20 = q_mul_sat(q_mul_sat(m->k_qd_q24, f->current_q18.d, 22), look->turn_q30, 30);
  return q_sat64(q_shr64(deviation_q46, 26) - turned_q20);
}

static bool mean_deviation(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, const look_t* look,
                           int32_t* mean_q20) {
  int32_t sum_q20 = 0;
  int32_t count = 0;
  for (uint16_t k = 0; k < in->window_count; k++) {
    const estimator_window_t* const w = &in->windows[k];
    estimator_frame_t own;
    if (!w->zero_vector) continue;
    if (in->frames == 0) {
      deviation_frames(w, 1, deviation_middle(angle_bam, speed_bpp), machine_speed_rad_q30(speed_bpp), &own);
    }
    sum_q20 = q_add_sat(sum_q20, deviation_of_q20(in->model, w, (in->frames != 0) ? &in->frames[k] : &own, look));
    count++;
  }
  if (count == 0) return false;
  *mean_q20 = sum_q20 / count;
  return true;
}

// The terms at a speed.
static look_t look_with(const machine_model_t* m, uint16_t terms, int32_t speed_bpp) {
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  const look_t look = {q_mul_sat(m->emf_q16, w_q30, 30), ((terms & ZVV_ROTATION) != 0u) ? w_q30 : 0,
                       (terms & ZVV_DROPS) != 0u};
  return look;
}

bool zvv_deviation_q20(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, int32_t* deviation_q20) {
  const look_t look = look_with(in->model, ZVV_DROPS, speed_bpp);
  return mean_deviation(in, angle_bam, speed_bpp, &look, deviation_q20);
}

// error_q27: D / Kq, turns; as many bits less than a binary angle as let ten of them add up.
static void correct(zvv_t* s, const zvv_config_t* c, int32_t error_q27, int32_t torque_accel_q8) {
  const int32_t accel_q8 = q_mul_sat(error_q27, c->ki_q40, 27);
  const int32_t step = q_sat64((int64_t)accel_q8 * s->waited);
  s->integral_q8bpp = q_clamp(q_add_sat(s->integral_q8bpp, step), -INTEGRAL_LIMIT, INTEGRAL_LIMIT);
  s->speed_bpp = q_shr(s->integral_q8bpp, 8) + q_mul(error_q27, c->kp_q30, 25);
  // Fig. 7: what the torque makes less what the speed makes of it; the integral's input is the speed's derivative.
  const int32_t left_q8 = q_sub_sat(q_sub_sat(torque_accel_q8, accel_q8), s->load_accel_q8);
  if ((c->terms & ZVV_LOAD) != 0u)
    s->load_accel_q8 = q_add_sat(s->load_accel_q8, q_mul(left_q8, LOAD_SHARE_Q30 * s->waited, 30));
}

void zvv_wait(zvv_t* s) {
  s->angle_bam += (uint32_t)s->speed_bpp;
  s->waited = q_min(s->waited + 1, ZVV_PERIODS);
}

estimator_output_t zvv_step(zvv_t* s, const zvv_config_t* c, const estimator_input_t* in, int32_t id_reference_q20) {
  const machine_model_t* m = in->model;
  const bool alone = (c->terms & ZVV_INTEGRAL) != 0u;
  zvv_wait(s);
  const look_t look = look_with(m, c->terms, alone ? q_shr(s->integral_q8bpp, 8) : s->speed_bpp);
  const bool seen = mean_deviation(in, s->angle_bam, s->speed_bpp, &look, &s->deviation_q20);
  // Kq in A per period and rad (24).
  const int32_t volts_q16 = q_mul_sat(m->rs_q24, id_reference_q20, 28);
  const int32_t kq_q20 = q_neg_sat(q_mul_sat(m->yd_q30 - m->yq_q30, volts_q16, 26));
  const bool usable = seen && kq_q20 != 0;
  if (usable) {
    const int32_t error_q24 = q_limit(q_div(s->deviation_q20, kq_q20, 24), ERROR_LIMIT_Q24);
    correct(s, c, q_mul(error_q24, ANGLE_BAM_PER_RAD, 29), in->torque_accel_q8);
    s->waited = 0;
  }
  const estimator_output_t out = {s->angle_bam, alone ? q_shr(s->integral_q8bpp, 8) : s->speed_bpp, s->load_accel_q8,
                                  usable ? 32767 : 0};
  return out;
}

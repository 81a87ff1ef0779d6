#include "estimators/zvv.h"

#include "estimators/deviation.h"

#define ERROR_LIMIT_Q24 4392264L  // 15 degrees: more than that a linearised D does not tell
#define INTEGRAL_LIMIT 2000000000L
#define ONE_Q26 67108864L
#define RAD_Q24_TO_BAM 683565276L  // 2^32 / (2 pi), for a product shifted by 24

void zvv_preset(zvv_t* s, uint32_t angle_bam, int32_t speed_bpp) {
  s->angle_bam = angle_bam;
  s->speed_bpp = speed_bpp;
  s->integral_q8bpp = q_shl_sat(speed_bpp, 8);
  s->waited = 0;
}

// D (22) and its voltage over the windows; both are sums until mean_deviation divides them.
typedef struct {
  int32_t deviation_q20;  // A per period
  int32_t volts_q16;      // what the devices take along the d-axis, V
} seen_t;

// One window; emf_q16: w lambda of the speed that D takes off.
static void see(seen_t* sum, const machine_model_t* m, const estimator_window_t* w, const estimator_frame_t* f,
                int32_t emf_q16) {
  const dq_t change_q19 = frame_park(w->change_q19, f->rotation);
  const dq_t drop_q17 = frame_park_hi(w->voltage_q19, f->rotation);
  const int32_t volts_q16 = q_sat64(q_mul64(m->rs_q24, f->current_q18.q, 26) + emf_q16 - q_shr(drop_q17.q, 1));
  const int32_t slope_q20 = deviation_slope_q20(change_q19.q, 19, w->span_ticks);
  const int64_t deviation_q46 = q_mac(q_product(m->yq_q30, volts_q16), slope_q20, ONE_Q26) + ONE_Q26 / 2;
  sum->deviation_q20 = q_sat64(q_shr64(deviation_q46, 26) + sum->deviation_q20);
  sum->volts_q16 -= q_shr(drop_q17.d, 1);
}

static bool mean_deviation(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, int32_t emf_bpp,
                           seen_t* mean) {
  seen_t sum = {0, 0};
  int32_t count = 0;
  const int32_t emf_q16 = q_mul_sat(in->model->emf_q16, machine_speed_rad_q30(emf_bpp), 30);
  for (uint16_t k = 0; k < in->window_count; k++) {
    const estimator_window_t* const w = &in->windows[k];
    estimator_frame_t own;
    if (!w->zero_vector) continue;
    if (in->frames == 0) {
      deviation_frames(w, 1, deviation_middle(angle_bam, speed_bpp), machine_speed_rad_q30(speed_bpp), &own);
    }
    see(&sum, in->model, w, (in->frames != 0) ? &in->frames[k] : &own, emf_q16);
    count++;
  }
  if (count == 0) return false;
  mean->deviation_q20 = sum.deviation_q20 / count;
  mean->volts_q16 = sum.volts_q16 / count;
  return true;
}

bool zvv_deviation_q20(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, int32_t* deviation_q20) {
  seen_t mean;
  if (!mean_deviation(in, angle_bam, speed_bpp, speed_bpp, &mean)) return false;
  *deviation_q20 = mean.deviation_q20;
  return true;
}

static void correct(zvv_t* s, const zvv_config_t* c, int32_t error_bam) {
  const int32_t step = q_mul(error_bam * s->waited, c->ki_q40, 32);
  s->integral_q8bpp = q_clamp(q_add_sat(s->integral_q8bpp, step), -INTEGRAL_LIMIT, INTEGRAL_LIMIT);
  s->speed_bpp = q_shr(s->integral_q8bpp, 8) + q_mul(error_bam, c->kp_q30, 30);
}

void zvv_wait(zvv_t* s) {
  s->angle_bam += (uint32_t)s->speed_bpp;
  s->waited = q_min(s->waited + 1, ZVV_PERIODS);
}

estimator_output_t zvv_step(zvv_t* s, const zvv_config_t* c, const estimator_input_t* in, int32_t id_reference_q20) {
  const machine_model_t* m = in->model;
  seen_t mean = {s->deviation_q20, 0};
  zvv_wait(s);
  const bool seen = mean_deviation(in, s->angle_bam, s->speed_bpp, q_shr(s->integral_q8bpp, 8), &mean);
  s->deviation_q20 = mean.deviation_q20;
  // Kq in A per period and rad (24). What the devices take along the d-axis acts like R i_d.
  const int32_t volts_q16 = q_add_sat(q_mul_sat(m->rs_q24, id_reference_q20, 28), mean.volts_q16);
  const int32_t kq_q20 = q_neg_sat(q_mul_sat(m->yd_q30 - m->yq_q30, volts_q16, 26));
  const bool usable = seen && kq_q20 != 0;
  if (usable) {
    const int32_t error_q24 = q_clamp(q_div(s->deviation_q20, kq_q20, 24), -ERROR_LIMIT_Q24, ERROR_LIMIT_Q24);
    correct(s, c, q_mul(error_q24, RAD_Q24_TO_BAM, 24));
    s->waited = 0;
  }
  const estimator_output_t out = {s->angle_bam, s->speed_bpp, 0, usable ? 32767 : 0};
  return out;
}

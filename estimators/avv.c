#include "estimators/avv.h"

// log2 of the information of windows that are as short, and as long, as the bandwidths are meant for.
#define SHORT_LOG2 21
#define LONG_LOG2 27
#define STEP_Q22 (4194304L / (4 * (LONG_LOG2 - SHORT_LOG2)))

void avv_preset(avv_t* s, uint32_t angle_bam, int32_t speed_bpp, int32_t load_accel_q8) {
  tracking_observer_preset(&s->observer, angle_bam, speed_bpp, load_accel_q8);
  s->error_bam = 0;
  s->regression.information = 0;
}

// Half the turn of the saliency from where the model has it: eq (41) in the observed frame. The model's saliency is
// (h, c) = ((ydd - yqq)/2, ydq), the measured one (h + mirror, c + cross) per spread; their quotient needs no second
// arc tangent.
int32_t avv_angle_error(const regression_t* r, const machine_model_t* m) {
  const int32_t h_q30 = (m->yd_q30 - m->yq_q30) / 2;
  const int32_t c_q30 = m->ydq_q30;
  const int32_t along_q16 = q_sat64(q_shr64(q_product(h_q30, r->spread_q8), 22) + r->mirror_q16);
  const int32_t across_q16 = q_sat64(q_shr64(q_product(c_q30, r->spread_q8), 22) + r->cross_q16);
  const int64_t sine_q46 = q_product(across_q16, h_q30) - q_product(along_q16, c_q30);
  const int64_t cosine_q46 = q_mac(q_product(along_q16, h_q30), across_q16, c_q30);
  return (int32_t)q_atan2(q_sat64(q_shr64(sine_q46, 20)), q_sat64(q_shr64(cosine_q46, 20))) / 2;
}

// Information (4 or more) in powers of two, with two bits of fraction: the two bits below the highest.
static int32_t log2_q2(int32_t x) {
  const unsigned below = 29u - q_clz32((uint32_t)x);
  return (int32_t)(below + 2u) * 4 + (q_shr(x, below) & 3);
}

static int32_t bandwidth_q30(const avv_config_t* c, int32_t information) {
  const int32_t above = q_clamp(log2_q2(q_max(information, 4)) - 4 * SHORT_LOG2, 0, 4 * (LONG_LOG2 - SHORT_LOG2));
  return q_mix(c->bandwidth_short_q30, c->bandwidth_long_q30, above * STEP_Q22, 22);
}

estimator_output_t avv_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in) {
  tracking_observer_predict(&s->observer, in->torque_accel_q8);
  deviation_change_t seen[ESTIMATOR_WINDOWS];
  if (in->window_count > 0u) (void)deviation_see(in, s->observer.angle_bam, s->observer.speed_bpp, seen);
  regression_evaluate(&s->regression, seen, in);
  if (s->regression.information > 0) {
    s->error_bam = avv_angle_error(&s->regression, in->model);
    tracking_observer_correct(&s->observer, s->error_bam, bandwidth_q30(c, s->regression.information));
  }
  const estimator_output_t out = {s->observer.angle_bam, s->observer.speed_bpp, s->observer.load_accel_q8,
                                  (s->regression.information > 0) ? 32767 : 0};
  return out;
}

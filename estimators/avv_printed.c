#include "estimators/avv.h"
#include "estimators/deviation.h"
#include "hal/qmath/qcall.h"

#define MOST_Q17 268435456L

// The phase that an active vector has alone at one side of the link: 100, 011 are a's, 010, 101 are b's.
static uint16_t phase_of(ab_t volts) {
  if (qc_abs_sat(volts.beta) < qc_abs_sat(volts.alpha) / 2) return 0;
  return ((volts.alpha < 0) != (volts.beta < 0)) ? 1 : 2;
}

static int32_t along(ab_t x, uint16_t phase) {
  const abc_t all = frame_inverse_clarke(x);
  return (phase == 0) ? all.a : (phase == 1) ? all.b : all.c;
}

// Of a phase's current, A per period.
static int32_t slope_q18(const estimator_window_t* w, uint16_t phase) {
  return qc_mul_sat(along(w->change_q19, phase), DEVIATION_PERIOD_Q17 / w->span_ticks, 18);
}

// (37), less its mean over all angles, so that the sum of three phases is nothing. Along the vector, within 2048 A.
static int32_t left_of(const estimator_window_t* w, const estimator_window_t* zero, uint16_t phase, int32_t mean_q30) {
  const int32_t volts_q19 = along(w->voltage_q19, phase);
  const int32_t apart_q18 = qc_sub_sat(slope_q18(w, phase), slope_q18(zero, phase));
  const int32_t left_q17 = q_limit(apart_q18 / 2 - qc_mul(mean_q30, volts_q19, 32), MOST_Q17);
  return (volts_q19 < 0) ? -left_q17 : left_q17;
}

bool avv_printed_angle(const estimator_input_t* in, uint32_t* doubled_bam) {
  const int32_t mean_q30 = in->model->yd_q30 / 2 + in->model->yq_q30 / 2;
  const estimator_window_t *zero = 0, *one = 0, *other = 0;
  for (uint16_t k = 0; k < in->window_count; k++) {
    const estimator_window_t* const w = &in->windows[k];
    if (w->zero_vector) {
      zero = w;
    } else if (one == 0) {
      one = w;
    } else {
      other = w;
    }
  }
  if (zero == 0 || other == 0) return false;
  const estimator_window_t* const active[2] = {one, other};
  uint16_t phase[2];
  int32_t left_q17[2];
  for (uint16_t k = 0; k < 2u; k++) {
    phase[k] = phase_of(active[k]->voltage_q19);
    left_q17[k] = left_of(active[k], zero, phase[k], mean_q30);
  }
  if (phase[0] == phase[1]) return false;
  // (38), (41)
  const int32_t rest_q17 = -left_q17[0] - left_q17[1];
  int32_t of_q17[3] = {rest_q17, rest_q17, rest_q17};
  of_q17[phase[0]] = left_q17[0];
  of_q17[phase[1]] = left_q17[1];
  const ab_t d_q17 = frame_clarke2(of_q17[0], of_q17[1]);
  *doubled_bam = q_atan2(-d_q17.beta, d_q17.alpha);
  return true;
}

estimator_output_t avv_printed_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in) {
  tracking_observer_predict(&s->observer, in->torque_accel_q8);
  uint32_t doubled_bam = 0;
  const bool seen = avv_printed_angle(in, &doubled_bam);
  s->regression.information = 0;
  if (seen) {
    const uint32_t middle_bam = deviation_middle(s->observer.angle_bam, s->observer.speed_bpp);
    s->error_bam = (int32_t)(doubled_bam - 2u * middle_bam) / 2;
    tracking_observer_correct(&s->observer, s->error_bam, c->bandwidth_short_q30);
  }
  const estimator_output_t out = {s->observer.angle_bam, s->observer.speed_bpp, s->observer.load_accel_q8,
                                  seen ? 32767 : 0};
  return out;
}

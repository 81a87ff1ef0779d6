// The estimators that look at windows: deviation, regression, AVV and ZVV, what learns from them, slopes of samples.

#include "estimators/avv.h"
#include "estimators/blend.h"
#include "estimators/deviation.h"
#include "estimators/inverse_inductance.h"
#include "estimators/sensor_match.h"
#include "estimators/slopes.h"
#include "estimators/synchronism.h"
#include "estimators/voltage_match.h"
#include "estimators/zvv.h"
#include "tests/prove/any_windows.h"

static surroundings_t around;

static int32_t any_share(void) { return any_from(0, 53687091L); }

static void follow_angle(void) {
  tracking_observer_t s;
  tracking_observer_preset(&s, any_u32, any_speed(), any_i32);
  while (any_bool()) {
    tracking_observer_predict(&s, any_i32);
    //@ assert -1230417497 <= s.speed_bpp <= 1230417497;
    if (any_bool()) tracking_observer_correct(&s, any_i32, any_from(0, 107374182L));
    //@ assert -1298773986 <= s.speed_bpp <= 1298773986;
  }
}

static estimator_output_t any_output(void) {
  const estimator_output_t out = {any_u32, any_i32, any_i32, any_from(0, 32767)};
  return out;
}

static void hand_over(void) {
  blend_config_t c;
  blend_t s;
  if (!blend_design(&c, any_from(1, SPEED_MAX_BPP), any_from(1, SPEED_MAX_BPP))) return;
  blend_reset(&s);
  while (any_bool()) {
    const estimator_output_t low = any_output();
    const estimator_output_t high = any_output();
    if (any_bool()) blend_preset(&s, &c, any_i32);
    (void)blend_step(&s, &c, &low, &high);
  }
}

static void evaluate_slopes(void) {
  slopes_config_t c = {0, START_SAMPLES, END_SAMPLES, any_from(0, AMPERES_PER_COUNT_MAX_Q36)};
  const slopes_trim_t trim = {any_from(OFFSET_MIN_Q8, OFFSET_MAX_Q8), any_from(OFFSET_MIN_Q8, OFFSET_MAX_Q8),
                              any_from(-MISMATCH_END_Q30, MISMATCH_END_Q30)};
  const slopes_scale_t scale = slopes_scale(&c, &trim);
  const uint16_t begin = START_SAMPLES * 4095u;
  const uint16_t end = END_SAMPLES * 4095u;
  const slopes_sums_t sums = {any_up_to(begin), any_up_to(begin), any_up_to(end), any_up_to(end)};
  estimator_window_t w;
  w.span_ticks = (int16_t)any_from(1, PERIOD_TICKS);
  slopes_evaluate(&scale, &sums, &w);
}

static void step_avv(const estimator_input_t* in) {
  const int32_t low_q30 = any_from(1, 107374182L);
  const avv_config_t c = {low_q30, any_from(low_q30, 107374182L)};
  avv_t s;
  avv_preset(&s, any_u32, any_speed(), any_i32);
  s.error_bam = any_i32;
  s.observer.speed_remainder_q8 = any_from(0, 255);
  (void)avv_step(&s, &c, in);
  (void)avv_angle_error(&s.regression, in->model);
  (void)avv_printed_step(&s, &c, in);
}

static void step_zvv(const estimator_input_t* in) {
  const zvv_config_t c = {any_from(0, 107374182L), any_from(0, 220000000L), (uint16_t)any_from(0, 31)};
  zvv_t s;
  zvv_preset(&s, any_u32, any_speed(), any_i32);
  s.integral_q8bpp = any_from(-2000000000L, 2000000000L);
  s.deviation_q20 = any_i32;
  (void)zvv_step(&s, &c, in, any_from(-CURRENT_MAX_Q20, CURRENT_MAX_Q20));
  (void)zvv_deviation_q20(in, any_u32, any_speed(), &s.deviation_q20);
}

static void learn(void) {
  int32_t mismatch_q30 = any_from(-53687091L, 53687091L);
  const regression_t r = any_regression();
  machine_model_t* const m = &around.model;
  any_model(m);
  if (any_bool()) inverse_inductance_preset(m, any_i32, any_i32);
  inverse_inductance_step(m, &r, q_invert(r.spread_q8), any_share());
  sensor_match_step(&mismatch_q30, &r, q_invert(r.spread_q8), q_invert(any_from(1, INT32_MAX)), any_share());
  any_model(m);
  if (any_bool()) voltage_match_resistance(m, any_i32);
  voltage_match_step(m, &r, machine_speed_rad_q30(any_speed()), any_share());
}

static void judge(const estimator_input_t* in) {
  const synchronism_config_t c = {any_from(0, 6553600L), any_from(0, 32768L), any_from(0, 10000)};
  synchronism_seen_t seen = {{0, 0}, 0, any_speed(), any_i32, any_from(1, 63)};
  synchronism_t s;
  s.error_q16.d = any_from(-49152000L, 49152000L);  // one and a half times the largest limit
  s.error_q16.q = any_from(-49152000L, 49152000L);
  s.turned_q16 = any_from(-49152000L, 49152000L);
  s.emf_q16 = any_from(-134217728L, 134217728L);  // 2048 V
  s.limit_q16 = any_from(0, 32768000L);
  s.debounce = any_from(0, 1000000000L);
  synchronism_look(&seen, in->model, in->windows, in->window_count, any_u32);
  (void)synchronism_judge(&s, &c, in->model, &seen, any_i32);
}

static void look(uint16_t of_case, uint16_t count) {
  const estimator_input_t in = any_input(&around, of_case, count);
  step_avv(&in);
  step_zvv(&in);
  judge(&in);
}

void prove_estimators(void) {
  follow_angle();
  hand_over();
  evaluate_slopes();
  learn();
  for (uint16_t count = 0; count <= ESTIMATOR_WINDOWS; count++) {
    for (uint16_t of_case = 0; of_case < SPAN_CASES; of_case++) {
      if (is_case_of(of_case, count)) look(of_case, count);
    }
  }
}

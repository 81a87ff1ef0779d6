// The estimators of the start, of the run-up and of the commissioning: with anything that windows can say, step after
// step.

#include "estimators/axis.h"
#include "estimators/emf_sign.h"
#include "estimators/fit.h"
#include "estimators/flying.h"
#include "estimators/followed.h"
#include "estimators/inertia_match.h"
#include "estimators/inverse_inductance_tensor.h"
#include "estimators/polarity.h"
#include "estimators/saturation.h"
#include "estimators/wiring.h"
#include "tests/prove/any_windows.h"

static machine_model_t model;

static int32_t any_current(void) { return any_from(AMPERES_Q20 / 8, CURRENT_MAX_Q20 / 4); }

static void move(void) {
  polarity_t s;
  s.current_q20 = 0;
  polarity_begin(&s, any_current(), any_i32, any_u32, any_i32);
  //@ loop widen_hints s.passes, 6; loop widen_hints s.tick, 159, 160;
  while (any_bool()) {
    s.bounded = any_bool();
    (void)polarity_step(&s, any_u32);
    if (any_bool()) polarity_again(&s, any_u32, any_i32);
  }
}

static void saturate(void) {
  static saturation_t s;
  const saturation_slopes_t slopes = {any_i32, any_i32};
  const int32_t current_q20 = any_current();
  any_model(&model);
  (void)saturation_is_visible(&model, &slopes, current_q20);
  saturation_begin(&s, &model, &slopes, current_q20);
  //@ loop unroll 3;
  for (uint16_t pass = 0; pass < 3u; pass++) {
    //@ loop unroll 324;
    for (uint16_t k = 0; k < SATURATION_LENGTH; k++) {
      const regression_t r = any_regression();
      any_model(&model);
      (void)saturation_step(&s, &r, &model);
    }
    (void)saturation_resistance_q24(&s, &model);
    saturation_again(&s);
  }
}

static void find_axis(void) {
  axis_t s;
  axis_begin(&s);
  any_model(&model);
  while (any_bool()) {
    const regression_t r = any_regression();
    axis_add(&s, &r);
    if (!axis_is_complete(&s)) continue;
    (void)axis_evaluate(&s, &model);
    (void)wiring_judge(&s, &model, any_from(0, AMPERES_Q20));
  }
}

static void follow(void) {
  followed_t f = {any_i32, any_i32};
  while (any_bool()) {
    const int16_t length = (int16_t)any_from(4, 32767);
    followed_step(&f, any_i16, length, any_i32, any_i32);
    (void)followed_well(&f, any_i32);
  }
}

static void look_at_emf(void) {
  emf_sign_t s;
  emf_sign_reset(&s);
  while (any_bool()) {
    const emf_sign_seen_t seen = {any_from(-VOLTAGE_MAX_Q16, VOLTAGE_MAX_Q16), any_dq(CURRENT_MAX_Q20), any_speed(),
                                  any_from(1, 64)};
    any_model(&model);
    if (any_bool()) emf_sign_look(&s, &model, &seen);
    (void)emf_sign_judge(&s, &model, any_speed());
  }
}

static flying_emf_t any_emf(int32_t least_tick, int32_t most_tick) {
  flying_pulse_t s;
  flying_begin(&s);
  any_model(&model);
  const int32_t tick = any_from(least_tick, most_tick);
  const uint16_t windows = (uint16_t)any_from(1, 30);
  for (uint16_t k = 0; k < windows; k++) {
    estimator_window_t w;
    any_window(&w, (int16_t)any_from(300, 10000));
    flying_add(&s, &model, &w, tick + 10000L * (int32_t)k);
  }
  (void)flying_current(&s);
  return flying_evaluate(&s, &model);
}

static void catch(void) {
  flying_rotor_t rotor;
  const flying_emf_t first = any_emf(0, 100000L);
  const flying_emf_t second = any_emf(500000L, 30000000L);
  (void)flying_pause(&first, &model, 5, 3000);
  (void)flying_resolve(&first, &second, &model, &rotor);
}

static void run_up(void) {
  inertia_match_t s;
  inertia_match_reset(&s);
  while (any_bool()) {
    const inertia_seen_t in = {any_u32, any_speed(), any_speed(), any_i32, any_i32, any_i32};
    //@ loop unroll 10;
    for (uint16_t k = 0; k < 10u; k++) inertia_match_add(&s, any_i32);
    (void)inertia_match_step(&s, &in, 10);
  }
}

void prove_start(void) {
  move();
  saturate();
  find_axis();
  follow();
  look_at_emf();
  catch();
  run_up();
}

static deviation_t any_deviation(void) {
  const deviation_t d = {any_dq(536870911L), any_dq(1000 * VOLTS_Q16)};
  return d;
}

static void measure_tensor(void) {
  tensor_sums_t s;
  tensor_axes_t axes;
  tensor_reset(&s);
  any_model(&model);
  while (any_bool()) {
    const deviation_t first = any_deviation();
    const deviation_t second = any_deviation();
    tensor_add(&s, &first, &second);
  }
  (void)tensor_solve(&s, &model, &axes);
  (void)tensor_inductance_q20(any_i32);
}

static void fit(uint16_t n) {
  int32_t x[FIT_POINTS];
  int32_t f[FIT_POINTS];
  int32_t y[FIT_POINTS];
  fit_plane_t out;
  for (uint16_t k = 0; k < FIT_POINTS; k++) {
    x[k] = any_from(-FIT_END, FIT_END);
    f[k] = any_from(-FIT_END, FIT_END);
    y[k] = any_from(-FIT_END, FIT_END);
  }
  (void)fit_plane(x, f, y, n, &out);
}

void prove_commissioning(void) {
  measure_tensor();
  for (uint16_t n = 3; n <= FIT_POINTS; n++) fit(n);
  (void)fit_ratio(any_i64, any_i64, (int16_t)any_from(-31, 62));
}

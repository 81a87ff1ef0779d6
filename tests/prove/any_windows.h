// A period's windows with any contents: any current and any change of it that two sensors can show, any voltage
// of a DC link of 2000 V, and spans that lie in the period one beside the other.

#ifndef STILLSPIN_TESTS_PROVE_ANY_WINDOWS_H
#define STILLSPIN_TESTS_PROVE_ANY_WINDOWS_H

#include "estimators/estimator.h"
#include "estimators/regression.h"
#include "tests/prove/any_model.h"

#define SPAN_CASES 7

static inline uint16_t longest_of(uint16_t of_case) { return (uint16_t)((of_case - 1u) % 3u); }

// Whether a case of so many windows is another than the first.
static inline bool is_case_of(uint16_t of_case, uint16_t count) { return of_case == 0u || longest_of(of_case) < count; }

// At most one of them is longer than half a period, and the longer it is the shorter are the others: in these cases an
// interval for each says enough of all.
static inline int16_t any_span(uint16_t window, uint16_t of_case) {
  if (of_case == 0u) return (int16_t)any_from(1, 5000);
  const bool longer = of_case > 3u;
  const bool own = window == longest_of(of_case);
  if (longer) return (int16_t)(own ? any_from(7501, 10000) : any_from(1, 2499));
  return (int16_t)(own ? any_from(5001, 7500) : any_from(1, 4999));
}

// A component of a current, for the sensors that go with the machine.
static inline int32_t any_up_to_end(int32_t most) {
  const int32_t end = q_min(most, any_current_end_q20);
  return any_from(-end, end);
}

static inline void any_window(estimator_window_t* w, int16_t span_ticks) {
  w->change_q19 = any_ab(CHANGE_MAX_Q19);
  w->current_q20.alpha = any_up_to_end(WINDOW_ALPHA_MAX_Q20);
  w->current_q20.beta = any_up_to_end(WINDOW_BETA_MAX_Q20);
  w->voltage_q19 = any_ab(8 * WINDOW_VOLTS_MAX_Q16);
  w->middle_tick = (int16_t)any_from(0, PERIOD_TICKS);
  w->span_ticks = span_ticks;
  w->zero_vector = any_bool();
}

static inline estimator_frame_t any_frame(void) {
  estimator_frame_t f;
  f.rotation = frame_rotation(any_u32);
  f.current_q18 = any_dq(any_current_end_q20 / 4);
  return f;
}

typedef struct {
  machine_model_t model;
  estimator_window_t windows[ESTIMATOR_WINDOWS];
  estimator_frame_t frames[ESTIMATOR_WINDOWS];
} surroundings_t;

static inline estimator_input_t any_input(surroundings_t* around, uint16_t of_case, uint16_t count) {
  any_model(&around->model);
  for (uint16_t k = 0; k < ESTIMATOR_WINDOWS; k++) {
    any_window(&around->windows[k], any_span(k, of_case));
    around->frames[k] = any_frame();
  }
  estimator_input_t in;
  in.model = &around->model;
  in.windows = around->windows;
  in.window_count = count;
  in.torque_accel_q8 = any_i32;
  in.regress = any_bool();
  in.renew = any_bool();
  in.refresh = any_bool();
  in.busy = any_bool();
  in.frames = any_bool() ? around->frames : 0;
  in.iq_q20 = any_up_to_end(INT32_MAX);
  return in;
}

static inline regression_t any_regression(void) {
  regression_t r;
  r.spread_q8 = any_from(0, INT32_MAX);
  r.along_q16 = any_i32;
  r.mirror_q16 = any_i32;
  r.cross_q16 = any_i32;
  r.curl_q16 = any_i32;
  r.information = any_from(0, INT32_MAX);
  r.mean_q20 = any_dq(INT32_MAX);
  return r;
}

#endif

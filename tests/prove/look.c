// What the deviation observer sees in a period's windows, any of them, with any tuning and any speed: what is read
// elsewhere with the promise of look_ranges.h. What is left unexplained goes with the number of its periods, and
// nothing reads it but the function that adds to it: that is asked number by number, with any residuals.

#include "estimators/deviation_observer.c"
#include "tests/prove/any_observer.h"
#include "tests/prove/any_windows.h"
#include "tests/prove/ends.h"

static surroundings_t around;

static deviation_residual_t any_left(int32_t periods) {
  deviation_residual_t left;
  left.d_q17 = any_from(-periods * LEFT_END_Q17, periods * LEFT_END_Q17);
  left.q_q17 = any_from(-periods * LEFT_END_Q17, periods * LEFT_END_Q17);
  left.span_ticks = periods * any_from(0, 3 * PERIOD_TICKS);
  left.periods = periods;
  return left;
}

static void look_once(const estimator_input_t* in) {
  const deviation_observer_config_t tuning = any_observer(&around.model);
  deviation_observer_t s;
  deviation_observer_preset(&s, any_u32, any_speed(), any_i32);
  s.speed_bpp = any_from(-SPEED_MAX_BPP - CHANGE_MAX_BPP, SPEED_MAX_BPP + CHANGE_MAX_BPP);
  s.residual = any_left(0);
  s.sensitivity =
      deviation_sensitivity(&around.model, machine_speed_rad_q30(any_speed()), any_dq(any_current_end_q20 / 2 * 3));
  s.is_sensitive = any_bool();
  s.regression = any_regression();
  s.regressed_bam = any_u32;
  (void)look(&s, &tuning, in);
}

static void leave_after(int32_t periods) {
  information_sums_t n;
  n.e_q17 = any_dq(LEFT_END_Q17);
  n.span_ticks = any_from(0, 3 * PERIOD_TICKS);
  deviation_residual_t left = any_left(periods);
  leave(&left, &n);
  //@ assert 1 <= left.periods <= 15 && 0 <= left.span_ticks <= left.periods * 30000;
  //@ assert WITHIN(left.d_q17, left.periods * LEFT_END_Q17) && WITHIN(left.q_q17, left.periods * LEFT_END_Q17);
}

static void leave_after_all(void) {
  for (int32_t periods = 0; periods < 16; periods++) leave_after(periods);
}

static void ask_left(void) {
  deviation_observer_t s;
  s.residual = any_left(any_from(0, 15));
  dq_t residual_q20;
  int32_t span_ticks;
  int32_t periods;
  (void)deviation_take_mean_residual(&s.residual, &residual_q20, &span_ticks, &periods);
}

void prove_look(void) {
  for (uint16_t count = 1; count <= ESTIMATOR_WINDOWS; count++) {
    for (uint16_t of_case = 0; of_case < SPAN_CASES; of_case++) {
      if (!is_case_of(of_case, count)) continue;
      const estimator_input_t in = any_input(&around, of_case, count);
      look_once(&in);
    }
  }
  leave_after_all();
  ask_left();
}

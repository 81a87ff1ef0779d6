// The deviation observer with anything that a period's windows may tell it (look_ranges.h) or with none, any torque and
// any tuning: one step from any state leads to such a state again (estimators_ranges.h). What it gathers over counted
// periods goes with their number, and is asked for number by number.

#include "estimators/cogging.h"
#include "tests/prove/any_observer.h"
#include "tests/prove/any_windows.h"
#include "tests/prove/ends.h"

static surroundings_t around;
static deviation_observer_config_t tuning;

static int32_t any_within(int32_t end) { return any_from(-end, end); }

static void any_covariance(deviation_observer_t* s) {
  s->p_aa = any_from(16, VARIANCE_END_Q20);
  s->p_ss = any_from(16, VARIANCE_END_Q20);
  s->p_ll = any_from(16, VARIANCE_END_Q20);
  s->p_as = any_within(VARIANCE_END_Q20);
  s->p_al = any_within(VARIANCE_END_Q20);
  s->p_sl = any_within(VARIANCE_END_Q20);
}

static void any_scores(deviation_observer_t* s) {
  s->mean_score_q20 = any_i32;
  s->score_power_q23 = any_from(0, POWER_END_Q23);
  s->score_remainder = any_up_to(255);
  s->noise_boost_q30 = any_from(0, 1073741824L);
  s->load_is_new = any_bool();
  s->load_step_suspected = any_bool();
}

static void any_cogging(cogging_t* c) {
  c->cos_q8 = any_within(COGGING_BOUND_END_Q8);
  c->sin_q8 = any_within(COGGING_BOUND_END_Q8);
  c->mean_q8 = any_i32;
  c->now_q8 = any_i32;
  c->stepped_bam = any_u32;
  c->known_q30 = any_from(0, 1073741824L);
  c->order = any_i32;
  c->wave = frame_rotation(any_u32);
  c->active = any_bool();
}

static deviation_gathered_t any_gathered(int32_t periods) {
  deviation_gathered_t g;
  g.as_q24 = (int64_t)periods * any_i32;
  g.aa_q21 = periods * any_from(0, INFORMATION_END_Q21);
  g.ss_q21 = periods * any_from(0, INFORMATION_END_Q21);
  g.periods = periods;
  return g;
}

static deviation_observer_t any_state(void) {
  deviation_observer_t s;
  deviation_observer_preset(&s, any_u32, any_speed(), any_i32);
  s.speed_remainder_q8 = any_up_to(255);
  any_covariance(&s);
  any_scores(&s);
  any_cogging(&s.cogging);
  s.sensitivity =
      deviation_sensitivity(&around.model, machine_speed_rad_q30(any_speed()), any_dq(any_current_end_q20 / 2 * 3));
  s.is_sensitive = any_bool();
  s.regression = any_regression();
  s.regressed_bam = any_u32;
  return s;
}

static void step(uint16_t count, int32_t gathered) {
  const estimator_input_t in = any_input(&around, 0, count);
  tuning = any_observer(&around.model);
  deviation_observer_t s = any_state();
  s.gathered = any_gathered(gathered);
  (void)deviation_observer_step(&s, &tuning, &in);
}

static void ask(void) {
  deviation_observer_t s = any_state();
  s.gathered = any_gathered(any_from(0, 11));
  (void)deviation_observer_is_due(&s);
  (void)deviation_observer_update_is_urgent(&s);
  deviation_observer_learn(&s, &tuning);
  deviation_observer_stands(&s);
  //@ assert OF_VARIANCE(s.p_aa) && OF_VARIANCE(s.p_ss) && OF_VARIANCE(s.p_ll) && WITHIN(s.p_al, VARIANCE_END_Q20);
  //@ assert WITHIN(s.p_as, VARIANCE_END_Q20) && WITHIN(s.p_sl, VARIANCE_END_Q20);
}

// What it begins with is such a state.
static void begin(void) {
  deviation_observer_t s;
  deviation_observer_preset(&s, any_u32, any_speed(), any_i32);
  //@ assert WITHIN(s.speed_bpp, SPEED_MAX_BPP) && s.speed_remainder_q8 == 0;
  //@ assert s.score_remainder == 0 && s.noise_boost_q30 == 0;
  //@ assert OF_VARIANCE(s.p_aa) && OF_VARIANCE(s.p_ss) && OF_VARIANCE(s.p_ll);
  //@ assert s.p_as == 0 && s.p_al == 0 && s.p_sl == 0 && FROM_TO(s.score_power_q23, 0, POWER_END_Q23);
  //@ assert s.gathered.periods == 0 && s.gathered.aa_q21 == 0 && s.gathered.as_q24 == 0 && s.gathered.ss_q21 == 0;
  //@ assert s.residual.periods == 0 && s.residual.span_ticks == 0 && s.residual.d_q17 == 0 && s.residual.q_q17 == 0;
  //@ assert s.cogging.cos_q8 == 0 && s.cogging.sin_q8 == 0 && s.cogging.known_q30 == 0;
}

void prove_observer(void) {
  for (int32_t gathered = 0; gathered < 12; gathered++) {
    step(0, gathered);
    step(1, gathered);
  }
  begin();
  ask();
}

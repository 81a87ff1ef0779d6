// The stator-flux family with any method, cut-off, adaptation, voltages to 2000 V and currents to 512 A, step after
// step.

#include "tests/prove/any_flux.h"

static machine_model_t model;

static flux_period_t any_period(void) {
  const flux_period_t p = {any_ab(VOLTAGE_MAX_Q16), any_ab(CURRENT_MAX_Q20), any_dq(2 * (CURRENT_MAX_Q20 - 1)),
                           any_dq(CURRENT_MAX_Q20), any_bool()};
  return p;
}

void prove_flux(void) {
  static flux_observer_t s;
  any_model(&model);
  flux_observer_config_t c;
  any_flux(&c);
  if (!flux_observer_config_valid(&c, &model)) return;
  flux_observer_reset(&s, &c, &model);
  (void)flux_adaptation_identify_q24(&model);
  while (any_bool()) {
    const estimator_input_t in = {&model, 0, 0, any_i32, false, false, false, false, 0, 0};
    const estimator_output_t now = {any_u32, any_speed(), any_i32, any_from(0, 32767)};
    const flux_period_t p = any_period();
    if (any_bool()) flux_observer_preset(&s, &now, any_dq(CURRENT_MAX_Q20));
    any_working_point(&model);
    (void)flux_observer_step(&s, &c, &in, &p);
    //@ assert 4194304 <= s.adaptation.shares.lq_q24 <= 20971520;
    //@ assert 8388608 <= s.adaptation.shares.psi_q24 <= 20971520;
  }
}

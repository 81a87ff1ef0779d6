#include "control/current_controller.h"

#include "hal/qmath/qcall.h"

// Bandwidth over the corner of the integrator.
#define RESET_RATIO 4
#define ONE_Q20 1048576L

static pi_config_t design_axis(const machine_model_t* m, int32_t inductance_q30, const current_design_t* d) {
  pi_config_t c;
  const int32_t step_q24 = q_div(d->bandwidth_rads * d->period_us * d->divider, 1000000L, 24);  // a T
  c.kp_q20 = qc_mul(inductance_q30, d->bandwidth_rads, 10);
  const bool own = d->corner == CURRENT_CORNER_MACHINE;
  c.ki_q20 = own ? qc_mul_sat(m->nominal_rs_q24, step_q24, 28) : qc_mul_sat(c.kp_q20, step_q24, 24) / RESET_RATIO;
  c.release_q20 = 4 * q_limit(q_div(c.ki_q20, c.kp_q20, 20), ONE_Q20 / 4);
  return c;
}

void current_controller_design(current_controller_config_t* c, const machine_model_t* m,
                               const current_design_t* design) {
  c->d = design_axis(m, m->ld_q30, design);
  c->q = design_axis(m, m->lq_q30, design);
}

void current_controller_reset(current_controller_t* s) {
  pi_reset(&s->d, 0);
  pi_reset(&s->q, 0);
}

void current_controller_limited(current_controller_t* s, const current_controller_config_t* c, dq_t excess_q16) {
  pi_limited(&s->d, &c->d, excess_q16.d);
  pi_limited(&s->q, &c->q, excess_q16.q);
}

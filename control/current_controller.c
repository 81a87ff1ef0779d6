#include "control/current_controller.h"

#include "hal/qmath/qcall.h"

// Bandwidth over the corner of the integrator.
#define RESET_RATIO 4
#define ONE_Q20 1048576L
#define MICRO 1000000L
#define HALF_Q30 536870912L

static void design_axis(pi_config_t* c, const machine_model_t* m, int32_t inductance_q30, const current_design_t* d) {
  const int32_t step_millionths = d->bandwidth_rads * d->period_us * d->divider;  // a T
  const int32_t kp_q20 = qc_mul(inductance_q30, d->bandwidth_rads, 10);
  const int32_t quarter_q30 = q_div(step_millionths, MICRO * RESET_RATIO, 30);
  // R a T of a L.
  int32_t corner_q30 = q_div(qc_mul_sat(m->nominal_rs_q24, quarter_q30, 28), kp_q20, 26);
  if (d->corner != CURRENT_CORNER_MACHINE) corner_q30 = q_max(corner_q30, quarter_q30);
  c->kp_q20 = kp_q20;
  c->corner_q32 = 4 * q_limit(corner_q30, HALF_Q30 - 1);
  c->release_q20 = 4 * q_min(q_shr(c->corner_q32, 12), ONE_Q20 / 4);
}

void current_controller_design(current_controller_config_t* c, const machine_model_t* m,
                               const current_design_t* design) {
  design_axis(&c->d, m, m->ld_q30, design);
  design_axis(&c->q, m, m->lq_q30, design);
}

void current_controller_reset(current_controller_t* s) {
  pi_reset(&s->d);
  pi_reset(&s->q);
}

void current_controller_limited(current_controller_t* s, const current_controller_config_t* c, dq_t excess_q16) {
  pi_limited(&s->d, &c->d, excess_q16.d);
  pi_limited(&s->q, &c->q, excess_q16.q);
}

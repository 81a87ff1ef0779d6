#include "control/current_controller.h"

// Q20 error times Q20 gain to Q16 volts.
#define ERROR_SHIFT 24u
// Bandwidth over the corner of the integrator.
#define RESET_RATIO 4

static pi_config_t design_axis(int32_t inductance_q30, int32_t bandwidth_rads, int32_t period_us) {
  pi_config_t c;
  const int32_t step_q24 = q_div(bandwidth_rads * period_us, 1000000L, 24);  // bandwidth * T
  c.kp_q20 = q_mul(inductance_q30, bandwidth_rads, 10);
  c.ki_q20 = q_mul(c.kp_q20, step_q24, 24) / RESET_RATIO;
  c.release_q20 = 4 * q_div(c.ki_q20, c.kp_q20, 20);
  c.error_shift = ERROR_SHIFT;
  return c;
}

bool current_controller_design(current_controller_config_t* c, const machine_model_t* m, int32_t bandwidth_rads,
                               int32_t period_us) {
  const int32_t step_ppm = bandwidth_rads * period_us;  // bandwidth * T in parts per million
  if (bandwidth_rads < 100 || step_ppm > 260000L) return false;
  c->d = design_axis(m->ld_q30, bandwidth_rads, period_us);
  c->q = design_axis(m->lq_q30, bandwidth_rads, period_us);
  return true;
}

void current_controller_reset(current_controller_t* s) {
  pi_reset(&s->d, 0);
  pi_reset(&s->q, 0);
}

dq_t current_controller_step(current_controller_t* s, const current_controller_config_t* c, const machine_model_t* m,
                             dq_t reference_q20, dq_t measured_q20, int32_t speed_bpp) {
  const dq_t rotational = machine_rotational_voltage_q16(m, measured_q20, speed_bpp);
  dq_t v;
  v.d = pi_step(&s->d, &c->d, reference_q20.d - measured_q20.d) + rotational.d;
  v.q = pi_step(&s->q, &c->q, reference_q20.q - measured_q20.q) + rotational.q;
  return v;
}

void current_controller_limited(current_controller_t* s, const current_controller_config_t* c, dq_t excess_q16) {
  pi_limited(&s->d, &c->d, excess_q16.d);
  pi_limited(&s->q, &c->q, excess_q16.q);
}

#include "control/machine_model.h"

static bool in_range(int32_t x, int32_t lo, int32_t hi) { return x >= lo && x <= hi; }

static bool parameters_valid(const machine_parameters_t* p) {
  return in_range(p->rs_q24, 16777L, 838860800L) && in_range(p->ld_q30, 21474L, 536870912L) &&
         in_range(p->lq_q30, p->ld_q30, 536870912L) && in_range(p->flux_q28, 268435L, 268435456L) &&
         in_range(p->inertia_q24, 168L, 16777216L) && in_range(p->pole_pairs, 1, 20) && in_range(p->period_us, 20, 500);
}

void machine_model_set_admittance(machine_model_t* m, int32_t yd_q30, int32_t yq_q30) {
  m->yd_q30 = yd_q30;
  m->yq_q30 = yq_q30;
  m->kappa_d_q24 = q_div(yd_q30 - yq_q30, yq_q30, 24);
  m->kappa_q_q24 = q_div(yd_q30 - yq_q30, yd_q30, 24);
}

bool machine_model_init(machine_model_t* m, const machine_parameters_t* p) {
  if (!parameters_valid(p)) return false;
  m->rs_q24 = p->rs_q24;
  m->ld_q30 = p->ld_q30;
  m->lq_q30 = p->lq_q30;
  m->flux_q28 = p->flux_q28;
  m->pole_pairs = p->pole_pairs;
  m->periods_per_second = q_div(1000000L, p->period_us, 0);
  // T in seconds as Q30 is period_us * 2^30 / 1e6.
  const int32_t period_q30 = q_div(p->period_us, 1000000L, 30);
  machine_model_set_admittance(m, q_div(period_q30, p->ld_q30, 30), q_div(period_q30, p->lq_q30, 30));
  m->emf_q16 = q_div(p->flux_q28, period_q30, 18);
  m->torque_q24 = q_div(3 * p->pole_pairs * (p->flux_q28 / 16), 2, 0);
  m->reluctance_q24 = q_div(3 * p->pole_pairs * ((p->ld_q30 - p->lq_q30) / 64), 2, 0);
  // p T^2 / (2 pi J) turns per period^2 and N m; T^2 2^32 / (2 pi) = period_us^2 * 6.83565e-4, here as Q22.
  const int32_t per_torque_q22 = p->period_us * p->period_us * 2867L;
  m->accel_q12 = q_mul_sat(q_div(per_torque_q22, p->inertia_q24, 14), 2 * p->pole_pairs, 1);
  // A constant at the end of its format is not the machine's.
  return m->accel_q12 < INT32_MAX && m->emf_q16 < INT32_MAX && m->yd_q30 < INT32_MAX && m->kappa_d_q24 < INT32_MAX;
}

int32_t machine_torque_constant_q24(const machine_model_t* m, int32_t id_q20) {
  // With a large positive i_d the reluctance would turn the sign; nobody wants to run there, and it is divided by.
  return q_max(m->torque_q24 + q_mul(m->reluctance_q24, id_q20, 20), m->torque_q24 / 4);
}

int32_t machine_torque_q16(const machine_model_t* m, dq_t current_q20) {
  return q_mul(machine_torque_constant_q24(m, current_q20.d), current_q20.q, 28);
}

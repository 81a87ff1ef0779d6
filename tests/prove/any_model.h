// A machine's model in operation, at any operating point and with anything learnt: every constant anywhere in the range
// that control/machine_model.h gives it. That the model stays in them is the business of the part control.

#ifndef STILLSPIN_TESTS_PROVE_ANY_MODEL_H
#define STILLSPIN_TESTS_PROVE_ANY_MODEL_H

#include "tests/prove/any_machine.h"

static inline q_inverse_t any_inverse(unsigned lowest, unsigned highest) {
  const q_inverse_t inverse = {any_from(0, INT32_MAX), (unsigned)any_from((int32_t)lowest, (int32_t)highest)};
  return inverse;
}

static inline machine_point_t any_point(void) {
  machine_point_t p;
  p.ydd_q30 = any_from(1, Y0_END_Q30);
  p.yqq_q30 = any_from(1, Y0_END_Q30);
  p.ydq_q30 = any_from(-Y_CROSS_END_Q30 / 2, Y_CROSS_END_Q30 / 2);
  p.psi_d_q16 = any_from(-FLUX_END_Q16, FLUX_END_Q16);
  p.psi_q_q16 = any_from(0, FLUX_END_Q16);
  return p;
}

static inline void any_nameplate(machine_model_t* m) {
  m->nominal_rs_q24 = any_from(16777L, RS_NOMINAL_MAX_Q24);
  m->ld_q30 = any_from(35792L, 536870912L);
  m->lq_q30 = any_from(35792L, 536870912L);
  m->per_ld = any_inverse(45u, 60u);
  m->flux_q28 = any_from(268435L, 268435456L);
  m->emf_q16 = any_from(131072L, FLUX_END_Q16);
  m->torque_q24 = any_from(25165L, 503316480L);
  m->reluctance_q24 = any_from(-377487360L, 0);
  m->accel_q12 = any_from(1, INT32_MAX - 1);
  m->torque_per_accel_q24 = any_from(8192L, INT32_MAX);
  m->periods_per_second = any_from(2000, 50000L);
  m->period_q30 = any_from(21474L, 536871L);
  for (uint16_t k = 0; k < MACHINE_MAP_POINTS; k++) m->map.points[k] = any_point();
  m->map.per_segment_q26 = any_from(2684354L, 268435456L);
  m->per_ydd0 = any_inverse(31u, 61u);
  m->per_yqq0 = any_inverse(31u, 61u);
  m->per_half0 = any_inverse(31u, 61u);
}

static inline int32_t any_learnt(void) { return any_from(LEAST_SHARE_Q24, 16777216L); }

// What adaptation leaves: inverse_inductance.h, voltage_match.h.
static inline void any_trim(machine_model_t* m) {
  m->trim.mean_q30 = any_from(-Y0_END_Q30 / 4, Y0_END_Q30 / 2);
  m->trim.half_q30 = any_from(-Y0_END_Q30 / 3, Y0_END_Q30 / 2);
  m->trim.ydd_q24 = any_learnt();
  m->trim.yqq_q24 = any_learnt();
  m->trim.ydq_q24 = any_learnt();
  m->trim.psi_share_q24 = any_i32;
  m->trim.rs_q24 = any_from(-RS_NOMINAL_MAX_Q24 / 2, RS_NOMINAL_MAX_Q24);
  m->trim.psi_q16 = any_from(-TRIM_FLUX_END_Q16, TRIM_FLUX_END_Q16);
  m->trim.psi_variance_q32 = any_from(0, MACHINE_PSI_VARIANCE_Q32);
}

// Two main inverse inductances and any direction.
static inline void any_inverse_inductance(machine_model_t* m) {
  const int32_t larger_q30 = any_from(1, Y_END_Q30);
  const int32_t smaller_q30 = any_from(1, larger_q30);
  const rotation_t twice = frame_rotation(any_u32);
  const int32_t half_q30 = (larger_q30 - smaller_q30) / 2;
  m->yd_q30 = q_clamp(q_add_sat(smaller_q30 + half_q30, q_mul(half_q30, twice.cos_q30, 30)), 0, Y_END_Q30);
  m->yq_q30 = q_clamp(q_sub_sat(smaller_q30 + half_q30, q_mul(half_q30, twice.cos_q30, 30)), 0, Y_END_Q30);
  m->ydq_q30 = q_mul(half_q30, twice.sin_q30, 30);
}

// The largest component of a current vector, for a machine whose K and k0 go with it (firmware/config/config.c).
static int32_t any_current_end_q20;

static inline void any_turn(machine_model_t* m) {
  any_current_end_q20 = any_from(AMPERES_Q20, CURRENT_MAX_Q20);
  const int32_t k_end_q24 = q_min(q_div(K0_END_Q20 / 3, any_current_end_q20, 24), TILT_END_Q24);
  m->k_dd_q24 = any_from(-k_end_q24, k_end_q24) / 2;
  m->k_dq_q24 = any_from(-k_end_q24, k_end_q24);
  m->k_qd_q24 = any_from(-k_end_q24, k_end_q24);
  m->k0_q20.d = any_from(-K0_END_Q20, K0_END_Q20);
  m->k0_q20.q = any_from(-K0_END_Q20, K0_END_Q20);
}

static inline void any_working_point(machine_model_t* m) {
  any_trim(m);
  m->rs_q24 = any_from(-RS_NOMINAL_MAX_Q24 / 2, 2 * RS_NOMINAL_MAX_Q24);
  m->iq_q20 = any_from(-CURRENT_MAX_Q20, CURRENT_MAX_Q20);
  any_inverse_inductance(m);
  m->slope.yqq_q30 = any_from(-2 * Y0_END_Q30, 2 * Y0_END_Q30);
  m->slope.ydq_q30 = any_from(-Y_CROSS_END_Q30, Y_CROSS_END_Q30);
  m->per_yq = any_inverse(31u, 61u);
  any_turn(m);
  m->psi_d_q16 = any_i32;
  m->psi_q_q16 = any_i32;
}

static inline void any_model(machine_model_t* m) {
  any_nameplate(m);
  any_working_point(m);
}

#endif

#include "estimators/flux_angle.h"

#define ONE_Q48 ((int64_t)1 << 48)
#define LARGEST_Q24 (FLUX_LARGEST * FLUX_ONE_Q24 - 1L)
#define FLOOR_Q24 4194304L  // a quarter: only with L_q below L_d can the denominator of (30) become that small

static int32_t per_unit(int32_t x) { return q_limit(x, LARGEST_Q24); }

flux_vectors_t flux_vectors(const flux_machine_t* f, ab_t flux_q16, ab_t current_q20) {
  const flux_vectors_t v = {
      {per_unit(q_over(flux_q16.alpha, f->per_psi, 24)), per_unit(q_over(flux_q16.beta, f->per_psi, 24))},
      {per_unit(q_mul_sat(current_q20.alpha, f->lq_per_psi_q30, 26)),
       per_unit(q_mul_sat(current_q20.beta, f->lq_per_psi_q30, 26))}};
  return v;
}

static int32_t cross_q24(const flux_vectors_t* v) { return frame_cross_q24(v->flux_q24, v->current_q24); }

int32_t flux_square_q24(const flux_vectors_t* v) { return frame_dot_q24(v->flux_q24, v->flux_q24); }

int32_t flux_reference_square_q24(const flux_machine_t* f, dq_t current_q20) {
  const ab_t p_q24 = {per_unit(q_add_sat(FLUX_ONE_Q24, q_mul_sat(current_q20.d, f->ld_per_psi_q30, 26))),
                      per_unit(q_mul_sat(current_q20.q, f->lq_per_psi_q30, 26))};
  return frame_dot_q24(p_q24, p_q24);
}

int32_t flux_torque_q16(const flux_machine_t* f, const flux_vectors_t* v) {
  // 3/2 p psi_m (p cross i), and i = x / (L_q / psi_m).
  const int32_t current_q20 = q_over(cross_q24(v), q_invert(f->lq_per_psi_q30), 26);
  return q_mul_sat(current_q20, f->torque_q24, 28);
}

uint32_t flux_stator_angle(const flux_vectors_t* v) { return q_atan2(v->flux_q24.beta, v->flux_q24.alpha); }

uint32_t flux_active_angle(const flux_vectors_t* v) {
  return q_atan2(v->flux_q24.beta - v->current_q24.beta, v->flux_q24.alpha - v->current_q24.alpha);
}

int32_t flux_load_angle_ft(const flux_vectors_t* v) {
  // (15) times |p|: no quotient, and nothing to guard.
  const int32_t along_q24 = q_sub_sat(flux_square_q24(v), frame_dot_q24(v->flux_q24, v->current_q24));
  return (int32_t)q_atan2(cross_q24(v), along_q24);
}

// y of (27) and (29).
static int32_t along_d_q24(const flux_machine_t* f, int32_t c_q24) {
  const int32_t bend_q24 = q_mul_add_sat(f->saliency_q24, f->saliency_q24, f->saliency_q24, 2 * FLUX_ONE_Q24, 24);
  const int64_t radicand_q48 = ONE_Q48 - (int64_t)bend_q24 * c_q24;
  if (radicand_q48 <= 0) return q_div(FLUX_ONE_Q24, bend_q24, 24);
  const int32_t root_q24 = (int32_t)q_sqrt64((uint64_t)radicand_q48);
  return q_div(c_q24, q_add_sat(FLUX_ONE_Q24, root_q24), 24);
}

dq_t flux_currents_q24(const flux_machine_t* f, const flux_vectors_t* v, int32_t square_q24) {
  const int32_t rest_q24 = q_add_sat(FLUX_ONE_Q24, frame_dot_q24(v->current_q24, v->current_q24));
  const int32_t y_q24 = along_d_q24(f, q_sub_sat(square_q24, rest_q24));
  const int32_t active_q24 = q_max(q_sub_sat(FLUX_ONE_Q24, q_mul_sat(f->saliency_q24, y_q24, 24)), FLOOR_Q24);
  const dq_t yz = {y_q24, q_div(cross_q24(v), active_q24, 24)};
  return yz;
}

int32_t flux_load_angle_dq(dq_t yz_q24) { return (int32_t)q_atan2(yz_q24.q, q_add_sat(FLUX_ONE_Q24, yz_q24.d)); }

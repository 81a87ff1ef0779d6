#include "estimators/flux_adaptation.h"

#include "hal/qmath/qcall.h"

#define ONE_Q30 1073741824L
#define SHARE_LEAST_Q24 4194304L  // as flux_machine.h has it
#define SHARE_MOST_Q24 20971520L
#define PSI_LEAST_Q24 8388608L
#define CURRENT_LEAST_Q24 167772L

bool flux_adaptation_config_valid(const flux_adaptation_config_t* c) {
  return q_in_range(c->saturation_q24, 0, FLUX_ONE_Q24) && c->lowest_bpp > 0 &&
         q_in_range(c->current_q24, CURRENT_LEAST_Q24, FLUX_ONE_Q24) && q_in_range(c->inductance_q30, 0, ONE_Q30) &&
         q_in_range(c->magnet_q30, 0, ONE_Q30);
}

void flux_adaptation_reset(flux_adaptation_t* s) {
  static const flux_shares_t nameplate = {FLUX_ONE_Q24, FLUX_ONE_Q24};
  s->shares = nameplate;
}

// L_q i_q / T over psi_q / T, less 1: by how much the secant inductance has fallen at a point of the map.
static int32_t fallen_q24(const machine_model_t* m, int32_t iq_q20, int32_t psi_q_q16) {
  const int32_t straight_q16 = qc_mul_sat(qc_mul_sat(m->lq_q30, m->periods_per_second, 14), iq_q20, 20);
  return qc_sub_sat(q_div(straight_q16, psi_q_q16, 24), FLUX_ONE_Q24);
}

int32_t flux_adaptation_identify_q24(const machine_model_t* m) {
  int64_t product = 0;  // Q24
  int64_t square = 0;   // Q16
  for (int32_t k = 1; k <= MACHINE_MAP_SEGMENTS; k++) {
    const int32_t iq_q20 = q_div(k * 32768L, m->map.per_segment_q26, 31);
    const machine_point_t* const p = &m->map.points[k];
    const int32_t torque_q16 =
        qc_mul_sat(qc_mul_sat(m->torque_q24, iq_q20, 28), q_div(p->psi_d_q16, m->emf_q16, 24), 24);
    product += q_mul64(fallen_q24(m, iq_q20, p->psi_q_q16), torque_q16, 16);
    square += q_mul64(torque_q16, torque_q16, 16);
  }
  return q_clamp(q_div(q_sat64(product), q_sat64(square), 16), 0, FLUX_ONE_Q24);
}

int32_t flux_adaptation_lq_q24(int32_t saturation_q24, int32_t torque_q16) {
  const int32_t less_q24 = q_mul_sat(saturation_q24, q_abs_sat(torque_q16), 16);
  return q_div(FLUX_ONE_Q24, q_add_sat(FLUX_ONE_Q24, less_q24), 24);
}

bool flux_adaptation_change_q24(const flux_machine_t* f, const flux_vectors_t* v, dq_t current_q20,
                                int32_t least_current_q24, int32_t* change_q24) {
  const int32_t length_q24 = q_hypot(v->flux_q24.alpha, v->flux_q24.beta);
  if (length_q24 == 0) return false;
  const q_inverse_t per_length = q_invert(length_q24);
  const int32_t along_q24 = qc_over(frame_dot_q24(v->flux_q24, v->current_q24), per_length, 24);
  const int32_t across_q24 = qc_over(frame_cross_q24(v->flux_q24, v->current_q24), per_length, 24);
  if (q_abs_sat(across_q24) < least_current_q24) return false;
  const int32_t d_q24 = qc_mul_sat(current_q20.d, f->ld_per_psi_q30, 26);
  const int32_t q_q24 = qc_mul_sat(current_q20.q, f->lq_per_psi_q30, 26);
  const int32_t seen_q24 = qc_mul_sat(qc_sub_sat(length_q24, along_q24), q_div(q_q24, across_q24, 24), 24);
  *change_q24 = qc_sub_sat(seen_q24, qc_add_sat(FLUX_ONE_Q24, d_q24));
  return true;
}

void flux_adaptation_step(flux_adaptation_t* s, const flux_adaptation_config_t* c, const machine_model_t* m,
                          flux_machine_t* f, const flux_vectors_t* v, dq_t current_q20, int32_t speed_bpp) {
  flux_shares_t* const to = &s->shares;
  const int32_t lq_q24 = flux_adaptation_lq_q24(c->saturation_q24, flux_torque_q16(f, v));
  int32_t change_q24 = 0;
  to->lq_q24 = q_clamp(q_mix(to->lq_q24, lq_q24, c->inductance_q30, 30), SHARE_LEAST_Q24, SHARE_MOST_Q24);
  if (c->magnet_q30 > 0 && q_abs_sat(speed_bpp) >= c->lowest_bpp &&
      flux_adaptation_change_q24(f, v, current_q20, c->current_q24, &change_q24)) {
    const int32_t step_q24 = q_mul_sat(q_mul_sat(change_q24, to->psi_q24, 24), c->magnet_q30, 30);
    to->psi_q24 = q_clamp(q_add_sat(to->psi_q24, step_q24), PSI_LEAST_Q24, SHARE_MOST_Q24);
  }
  flux_machine_move(f, m, to);
}

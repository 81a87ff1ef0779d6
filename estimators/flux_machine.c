#include "estimators/flux_machine.h"

#define LQ_PER_PSI_MAX_Q30 536870912L  // 0.5 1/A
#define SALIENCY_MAX_Q24 83886080L     // 6 - 1
#define BOUND_MAX_Q16 1966080000L      // 30000 V
#define LQ_LEAST_Q24 4194304L
#define PSI_LEAST_Q24 8388608L
#define MOST_Q24 20971520L

void flux_machine_move(flux_machine_t* f, const machine_model_t* m, const flux_shares_t* shares) {
  const int32_t lq_share_q24 = q_clamp(shares->lq_q24, LQ_LEAST_Q24, MOST_Q24);
  const int32_t psi_share_q24 = q_clamp(shares->psi_q24, PSI_LEAST_Q24, MOST_Q24);
  const int32_t lq_q30 = q_mul_sat(m->lq_q30, lq_share_q24, 24);
  const q_inverse_t per_flux = q_invert(q_mul(m->flux_q28, psi_share_q24, 24));
  f->psi_q16 = q_mul_sat(m->emf_q16, psi_share_q24, 24);
  f->per_psi = q_invert(f->psi_q16);
  f->bound_q16 = q_min(q_shl_sat(f->psi_q16, 3), BOUND_MAX_Q16);
  f->ld_per_psi_q30 = q_over(m->ld_q30, per_flux, 28);
  f->lq_per_psi_q30 = q_over(lq_q30, per_flux, 28);
  f->saliency_q24 = q_over(lq_q30, q_invert(m->ld_q30), 24) - FLUX_ONE_Q24;
  f->torque_q24 = q_mul_sat(m->torque_q24, psi_share_q24, 24);
}

bool flux_machine_init(flux_machine_t* f, const machine_model_t* m) {
  static const flux_shares_t nameplate = {FLUX_ONE_Q24, FLUX_ONE_Q24};
  flux_machine_t fresh;
  flux_machine_move(&fresh, m, &nameplate);
  if (fresh.lq_per_psi_q30 > LQ_PER_PSI_MAX_Q30 || fresh.saliency_q24 > SALIENCY_MAX_Q24) return false;
  *f = fresh;
  return true;
}

#include "control/machine_map.h"

#include "hal/qmath/qcall.h"

#define FLUX_END_Q16 2097152000L       // 32000 V
#define ADMITTANCE_END_Q30 644245094L  // 0.6 A/V: the estimators' formats end there
#define CROSS_END_Q30 483183820L       // 0.45
#define ONE_Q24 ((int32_t)16777216L)
#define ONE_Q30 1073741824L

// psi/T gained over a segment: mean inductance times its current, V per (rad per period), Q16.
static int32_t flux_gain_q16(int32_t l0_q30, int32_t l1_q30, int32_t step_q20, int32_t period_q30) {
  const int32_t flux_q28 = qc_mul_sat(l0_q30 / 2 + l1_q30 / 2, step_q20, 22);
  return q_div(flux_q28, period_q30, 18);
}

// T L^-1. The determinants of the machine are as small as 1e-9 H^2: 64 bits until the quotient.
static bool invert(machine_point_t* y, int32_t ldd_q30, int32_t lqq_q30, int32_t ldq_q30, int32_t period_q30) {
  // Leakage factors as quotients keep the digits: Ldd (1 - Ldq^2 / (Ldd Lqq)).
  const int32_t tilt_d_q30 = q_div(ldq_q30, ldd_q30, 30);
  const int32_t tilt_q_q30 = q_limit(q_div(ldq_q30, lqq_q30, 30), ONE_Q30);
  if (tilt_d_q30 <= -ONE_Q30 || tilt_d_q30 >= ONE_Q30) return false;
  const int32_t left_q30 = ONE_Q30 - qc_mul(tilt_d_q30, tilt_q_q30, 30);
  y->ydd_q30 = q_div(period_q30, qc_mul(ldd_q30, left_q30, 30), 30);
  y->ydq_q30 = qc_mul(y->ydd_q30, -tilt_q_q30, 30);
  if (y->ydd_q30 > ADMITTANCE_END_Q30 || !q_in_range(y->ydq_q30, -CROSS_END_Q30, CROSS_END_Q30)) return false;
  y->yqq_q30 = q_min(q_div(period_q30, qc_mul(lqq_q30, left_q30, 30), 30), y->ydd_q30);  // Lqq is not the smaller one
  return true;
}

bool machine_map_init(machine_map_t* map, const machine_map_parameters_t* p, int32_t period_q30, int32_t emf_q16) {
  if (p->current_q20 < 1048576L || p->current_q20 > 104857600L) return false;
  const int32_t step_q20 = p->current_q20 / MACHINE_MAP_SEGMENTS;
  map->per_segment_q26 = q_div(1048576L, step_q20, 26);
  int32_t psi_d_q16 = emf_q16;
  int32_t psi_q_q16 = 0;
  for (uint16_t k = 0; k < MACHINE_MAP_POINTS; k++) {
    machine_point_t* const y = &map->points[k];
    if (p->ldd_q30[k] <= 0 || p->lqq_q30[k] < p->ldd_q30[k]) return false;
    if (!invert(y, p->ldd_q30[k], p->lqq_q30[k], p->ldq_q30[k], period_q30)) return false;
    if (k > 0u) {
      psi_d_q16 = qc_add_sat(psi_d_q16, flux_gain_q16(p->ldq_q30[k - 1u], p->ldq_q30[k], step_q20, period_q30));
      psi_q_q16 = qc_add_sat(psi_q_q16, flux_gain_q16(p->lqq_q30[k - 1u], p->lqq_q30[k], step_q20, period_q30));
    }
    if (qc_abs_sat(psi_d_q16) > FLUX_END_Q16 || psi_q_q16 > FLUX_END_Q16) return false;
    y->psi_d_q16 = psi_d_q16;
    y->psi_q_q16 = psi_q_q16;
  }
  return true;
}

// As a straight line beyond b as well.
static int32_t beyond(int32_t a, int32_t b, int32_t share_q24) {
  return q_sat64(q_shr64(q_mac(q_product(a, ONE_Q24 - share_q24), b, share_q24), 24));
}

machine_point_t machine_map_at(const machine_map_t* map, int32_t iq_q20, machine_slope_t* slope) {
  const int32_t at_q24 = q_mul_sat(q_abs_sat(iq_q20), map->per_segment_q26, 22);
  const uint16_t k = (uint16_t)q_min((int32_t)((uint32_t)at_q24 >> 24), MACHINE_MAP_SEGMENTS - 1);
  const machine_point_t* const a = &map->points[k];
  const machine_point_t* const b = a + 1;
  const int32_t beyond_q24 = at_q24 - (int32_t)k * ONE_Q24;
  const int32_t share_q24 = q_clamp(beyond_q24, 0, ONE_Q24);
  machine_point_t p;
  p.ydd_q30 = q_mix(a->ydd_q30, b->ydd_q30, share_q24, 24);
  p.yqq_q30 = q_mix(a->yqq_q30, b->yqq_q30, share_q24, 24);
  p.ydq_q30 = q_mix(a->ydq_q30, b->ydq_q30, share_q24, 24);
  const bool ends = beyond_q24 > ONE_Q24;
  const int32_t yqq_q30 = b->yqq_q30 - a->yqq_q30;
  slope->yqq_q30 = ends ? 0 : (k == 0u) ? q_mul_hi(yqq_q30, share_q24 * 64) * 8 : yqq_q30;
  slope->ydq_q30 = ends ? 0 : b->ydq_q30 - a->ydq_q30;
  p.psi_d_q16 = beyond(a->psi_d_q16, b->psi_d_q16, beyond_q24);
  p.psi_q_q16 = beyond(a->psi_q_q16, b->psi_q_q16, beyond_q24);
  if (iq_q20 < 0) {
    slope->yqq_q30 = -slope->yqq_q30;
    p.ydq_q30 = -p.ydq_q30;
    p.psi_q_q16 = q_neg_sat(p.psi_q_q16);
  }
  return p;
}

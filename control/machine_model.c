#include "control/machine_model.h"

#include "hal/qmath/qcall.h"

#define ONE_Q20 ((int32_t)1048576L)
#define ONE_Q24 ((int32_t)16777216L)
#define RATIO_END_Q24 1056964608L  // 63: Lq/Ld less 1
#define T_END_Q24 187904819L       // 11.2: its square is below the largest r
#define INVERSE_STEPS 4u           // from twice or half of it
#define SETTLE_CALLS 2u            // and with that of the trim, from any to any
#define K0_END_Q20 1048576000L     // 1000 A per period
#define TORQUE_END_Q24 503316480L  // 30 N m/A
#define LEAST_SHARE_Q24 (-ONE_Q24 / 16 * 15)
#define K_BITS 30u     // 64
#define TILT_BITS 29u  // 32: K_dd counts twice
#define K0_BITS 30u    // 1024 A per period

// T in seconds as Q30 is period_us * 2^30 / 1e6.
static int32_t period_q30(int32_t period_us) { return q_div(period_us, 1000000L, 30); }

// k0 = -Y J psi0 with psi0 = psi(0, i_q) - L i_q: Y J L (0, i_q) is what K has already counted. h at (0, i_q) is
// -Y J psi + J (0, i_q): K there is taken off again. All of it as Q46, limited once.
static void place_flux(machine_model_t* m) {
  const int32_t iq_q20 = m->iq_q20;
  const int64_t own_d_q44 = q_product(ONE_Q24 + m->k_dq_q24, iq_q20);
  const int64_t own_q_q44 = q_product(m->k_dd_q24, iq_q20);
  const int64_t flux_d_q46 = q_product(m->yd_q30, m->psi_q_q16) - q_product(m->ydq_q30, m->psi_d_q16);
  const int64_t flux_q_q46 = q_product(m->ydq_q30, m->psi_q_q16) - q_product(m->yq_q30, m->psi_d_q16);
  m->k0_q20.d = q_sat_bits(flux_d_q46 - own_d_q44 * 4, 26, K0_BITS);
  m->k0_q20.q = q_sat_bits(flux_q_q46 + own_q_q44 * 4, 26, K0_BITS);
}

// K = J - Y J adj(Y) / det(Y), everything over yq^2: Y/yq = [r, t; t, 1], det = r - t^2.
static void renew_sensitivity(machine_model_t* m) {
  m->per_yq = q_invert(m->yq_q30);
  const int32_t t_q24 = q_limit(qc_over(m->ydq_q30, m->per_yq, 24), T_END_Q24);
  const int32_t r_q24 = qc_over(m->yd_q30, m->per_yq, 24);
  const int32_t t2_q24 = q_mul(t_q24, t_q24, 24);
  const int32_t per_det_q24 = qc_over(ONE_Q24, q_invert(r_q24 - t2_q24), 24);
  const int32_t g_q24 = q_mul_sat(q_add_sat(r_q24, ONE_Q24), per_det_q24, 24);
  const int64_t one_q48 = q_product(ONE_Q24, ONE_Q24);
  m->k_dd_q24 = -q_sat_bits(q_product(t_q24, g_q24), 24, TILT_BITS);
  m->k_dq_q24 = q_sat_bits(q_mac(q_product(r_q24 - ONE_Q24, ONE_Q24), t2_q24, g_q24), 24, K_BITS);
  m->k_qd_q24 = q_sat_bits(one_q48 - q_product(ONE_Q24 + t2_q24, per_det_q24), 24, K_BITS);
}

// 1 / x by Newton's steps from a value near it: one where x moves slowly, as what is learnt does; from far off the
// guess is halved or doubled with each.
static int32_t inverse_from(int32_t guess_q24, int32_t x_q24) {
  int32_t product_q24 = 0;
  for (uint16_t n = 0; n < INVERSE_STEPS && q_abs_sat(product_q24 - ONE_Q24) > ONE_Q24 / 1024; n++) {
    product_q24 = q_clamp(q_mul_sat(guess_q24, x_q24, 24), 0, ONE_Q24 / 2 * 3);
    guess_q24 = q_mul_sat(guess_q24, 2 * ONE_Q24 - product_q24, 24);
  }
  return guess_q24;
}

// Of a map below 0.6 A/V: as much again stays in the format, and something is always left.
static int32_t share_of_map(int32_t more_q30, q_inverse_t per_map) {
  return q_clamp(qc_over(more_q30, per_map, 24), LEAST_SHARE_Q24, ONE_Q24);
}

void machine_model_trim(machine_model_t* m, int32_t mean_q30, int32_t half_q30) {
  machine_trim_t* const t = &m->trim;
  t->mean_q30 = mean_q30;
  t->half_q30 = half_q30;
  t->ydd_q24 = share_of_map(mean_q30 + half_q30, m->per_ydd0);
  t->yqq_q24 = share_of_map(mean_q30 - half_q30, m->per_yqq0);
  t->ydq_q24 = share_of_map(half_q30, m->per_half0);
  t->psi_share_q24 = inverse_from(t->psi_share_q24, ONE_Q24 + t->yqq_q24);
}

void machine_model_settle(machine_model_t* m) {
  machine_trim_t* const t = &m->trim;
  for (uint16_t n = 0; n < SETTLE_CALLS; n++) {
    t->psi_share_q24 = inverse_from(t->psi_share_q24, ONE_Q24 + t->yqq_q24);
  }
}

static void admit(machine_model_t* m, int32_t iq_q20) {
  const machine_point_t p = machine_map_at(&m->map, iq_q20, &m->slope);
  m->iq_q20 = iq_q20;
  m->yd_q30 = q_mul(p.ydd_q30, ONE_Q24 + m->trim.ydd_q24, 24);
  m->yq_q30 = q_mul(p.yqq_q30, ONE_Q24 + m->trim.yqq_q24, 24);
  m->ydq_q30 = q_mul(p.ydq_q30, ONE_Q24 + m->trim.ydq_q24, 24);
  m->rs_q24 = m->nominal_rs_q24 + m->trim.rs_q24;
  m->psi_d_q16 = q_add_sat(p.psi_d_q16, m->trim.psi_q16);
  // An inductance that differs from the table's differs in its flux as well.
  m->psi_q_q16 = q_sat64(q_shr64(q_product(p.psi_q_q16, m->trim.psi_share_q24), 24));
}

void machine_model_follow(machine_model_t* m, int32_t iq_q20) {
  admit(m, iq_q20);
  place_flux(m);
}

void machine_model_renew_sensitivity(machine_model_t* m) {
  const int32_t dd_q24 = m->k_dd_q24;
  const int32_t dq_q24 = m->k_dq_q24;
  renew_sensitivity(m);
  // K i + k0 at (0, i_q) stays what it was.
  const int64_t more_d_q44 = q_product(m->k_dq_q24 - dq_q24, m->iq_q20);
  const int64_t more_q_q44 = q_product(m->k_dd_q24 - dd_q24, m->iq_q20);
  m->k0_q20.d = q_sat_bits(q_product(m->k0_q20.d, ONE_Q24) - more_d_q44, 24, K0_BITS);
  m->k0_q20.q = q_sat_bits(q_product(m->k0_q20.q, ONE_Q24) + more_q_q44, 24, K0_BITS);
}

void machine_model_move(machine_model_t* m, int32_t iq_q20) {
  admit(m, iq_q20);
  renew_sensitivity(m);
  place_flux(m);
}

bool machine_model_saturate(machine_model_t* m, const machine_map_parameters_t* map) {
  machine_map_t fresh;
  if (!machine_map_init(&fresh, map, m->period_q30, m->emf_q16)) return false;
  m->map = fresh;
  const machine_point_t* const p = &fresh.points[0];
  m->per_ydd0 = q_invert(p->ydd_q30);
  m->per_yqq0 = q_invert(p->yqq_q30);
  m->per_half0 = q_invert((p->ydd_q30 - p->yqq_q30) / 2);
  machine_model_move(m, 0);
  return true;
}

static bool unsaturated(machine_model_t* m) {
  machine_map_parameters_t flat;
  flat.current_q20 = 4194304L;
  for (uint16_t k = 0; k < MACHINE_MAP_POINTS; k++) {
    flat.ldd_q30[k] = m->ld_q30;
    flat.lqq_q30[k] = m->lq_q30;
    flat.ldq_q30[k] = 0;
  }
  return machine_model_saturate(m, &flat);
}

// One by one: a constant to copy would be as long as the memory itself.
static void forget_trim(machine_trim_t* t) {
  t->mean_q30 = 0;
  t->half_q30 = 0;
  t->ydd_q24 = 0;
  t->yqq_q24 = 0;
  t->ydq_q24 = 0;
  t->psi_share_q24 = ONE_Q24;
  t->rs_q24 = 0;
  t->psi_q16 = 0;
  t->psi_variance_q32 = MACHINE_PSI_VARIANCE_Q32;
}

bool machine_model_init(machine_model_t* m, const machine_parameters_t* p) {
  m->nominal_rs_q24 = p->rs_q24;
  m->ld_q30 = p->ld_q30;
  m->lq_q30 = p->lq_q30;
  m->per_ld = q_invert(p->ld_q30);
  m->flux_q28 = p->flux_q28;
  m->period_q30 = period_q30(p->period_us);
  m->periods_per_second = (int32_t)((1000000L + p->period_us / 2) / p->period_us);
  m->ld_q16 = qc_mul_sat(p->ld_q30, m->periods_per_second, 14);
  m->emf_q16 = q_div(p->flux_q28, m->period_q30, 18);
  m->torque_q24 = q_div(3 * p->pole_pairs * (p->flux_q28 / 16), 2, 0);
  m->reluctance_q24 = q_div(3 * p->pole_pairs * ((p->ld_q30 - p->lq_q30) / 64), 2, 0);
  forget_trim(&m->trim);
  // p T^2 / (2 pi J) turns per period^2 and N m; T^2 2^32 / (2 pi) = period_us^2 * 6.83565e-4, here as Q22.
  const int32_t per_torque_q22 = p->period_us * p->period_us * 2867L;
  m->accel_q12 = qc_mul_sat(q_div(per_torque_q22, p->inertia_q24, 14), 2 * p->pole_pairs, 1);
  m->torque_per_accel_q24 = q_div(1048576L, m->accel_q12, 24);
  // A constant at the end of its format is not the machine's.
  return m->accel_q12 < INT32_MAX && m->torque_q24 <= TORQUE_END_Q24 && unsaturated(m) && m->k_dq_q24 < RATIO_END_Q24 &&
         m->k0_q20.q > -K0_END_Q20;
}

void machine_model_scale_inertia(machine_model_t* m, const machine_model_t* nominal, int32_t ratio_q24) {
  m->accel_q12 = qc_mul_sat(nominal->accel_q12, ratio_q24, 24);
  m->torque_per_accel_q24 = qc_over(nominal->torque_per_accel_q24, q_invert(ratio_q24), 24);
}

int32_t machine_torque_constant_q24(const machine_model_t* m, int32_t id_q20) {
  // With a large positive i_d the reluctance would turn the sign; nobody wants to run there, and it is divided by.
  const int64_t constant_q44 = q_mac(q_product(m->torque_q24, ONE_Q20), m->reluctance_q24, id_q20);
  return q_max(q_sat64(q_shr64(constant_q44, 20)), q_shr(m->torque_q24, 2));
}

int32_t machine_torque_q16(const machine_model_t* m, dq_t current_q20) {
  return q_mul(machine_torque_constant_q24(m, current_q20.d), current_q20.q, 28);
}

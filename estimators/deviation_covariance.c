#include "estimators/deviation_covariance.h"

#include "hal/qmath/qcall.h"

#define ONE_Q30 1073741823L
#define BOOST_SHIFT 9u                    // the boost fades within 51 ms
#define STEP_AGE_Q30 268435456L           // 16 periods
#define STEP_AGE_UNMAPPED_Q30 536870912L  // 32 periods

typedef struct {
  int32_t a, s;
} gain_t;

// 1 at a crawl, 0 from three times that speed.
static int32_t crawl_share_q30(const deviation_observer_t* s, const deviation_observer_config_t* c) {
  const int32_t above = q_abs_sat(s->speed_bpp) - c->cogging.crawl_bpp;
  return ONE_Q30 - q_min(q_over(q_max(above, 0), c->per_crawl, 30), ONE_Q30);
}

// A step is noticed when it has already turned the shaft: a load that changed some time ago has left speed and angle
// behind as well, all of them in proportion, and the covariance says by how much. Where the map is missing, and no step
// is looked out for at speed, the angle seen turns with the current that answers the load, and it is noticed late.
static void admit_load_step(deviation_observer_t* s, const deviation_observer_config_t* c, int32_t variance_q20) {
  const int32_t age_q30 = (c->moving_step_q20 > 0) ? STEP_AGE_Q30 : STEP_AGE_UNMAPPED_Q30;
  const int32_t sl_q20 = q_mul(variance_q20, age_q30, 30);
  const int32_t ss_q20 = q_mul(sl_q20, age_q30, 30);
  const int32_t as_q20 = q_mul(ss_q20, age_q30, 31);
  s->p_ll += variance_q20;
  s->p_sl += sl_q20;
  s->p_ss += ss_q20;
  s->p_al += ss_q20 / 2;
  s->p_as += as_q20;
  s->p_aa += q_mul(as_q20, age_q30, 31);
}

// Cogging that is not known yet is a load that changes with the angle. An eighth of the variance is a bandwidth lower
// by the root of two, since that goes with the load's rate to the third.
static int32_t quiet_noise_q20(const deviation_observer_t* s, const deviation_observer_config_t* c) {
  return c->load_noise_quiet_q20 - q_shr(q_mul_floor(c->load_noise_quiet_q20, s->cogging.known_q30, 30), 3) * 7;
}

static void admit_load_change(deviation_observer_t* s, const deviation_observer_config_t* c, bool suspected) {
  const int32_t periods = s->gathered.periods;
  const int32_t crawl_q30 = crawl_share_q30(s, c);
  s->noise_boost_q30 = q_max(s->noise_boost_q30 - periods * q_shr_round(s->noise_boost_q30, BOOST_SHIFT), 0);
  const int32_t step_q20 = c->moving_step_q20 + q_mul_floor(c->load_step_q20 - c->moving_step_q20, crawl_q30, 30);
  const int32_t again_q30 = (crawl_q30 > 0) ? DEVIATION_BOOST_AGAIN_Q30 : DEVIATION_BOOST_OVER_Q30;
  if (suspected && step_q20 > 0 && s->noise_boost_q30 < again_q30) {
    s->noise_boost_q30 = ONE_Q30;
    admit_load_step(s, c, step_q20);
  }
  const int32_t quiet_q30 = crawl_q30 - q_mul_floor(crawl_q30, s->noise_boost_q30, 30);
  s->p_ll += periods * (c->load_noise_q20 - q_mul_floor(c->load_noise_q20 - quiet_noise_q20(s, c), quiet_q30, 30));
}

// The covariance over the periods since it was last renewed; a period is 1/64 of the unit of time.
static void predict_covariance(deviation_observer_t* s) {
  const int32_t time_q32 = s->gathered.periods * 67108864L;
  const int32_t drawn = q_mul_hi(s->p_ss + s->p_al, time_q32);
  s->p_aa += q_mul_hi(2 * s->p_as + drawn, time_q32);
  s->p_as += drawn;
  s->p_al += q_mul_hi(s->p_sl, time_q32);
  s->p_ss += q_mul_hi(2 * s->p_sl + q_mul_hi(s->p_ll, time_q32), time_q32);
  s->p_sl += q_mul_hi(s->p_ll, time_q32);
}

typedef struct {
  int32_t aa_q21, as_q21, ss_q21;
} known_t;

// (x_a I_aa + x_s I_as, x_a I_as + x_s I_ss), Q16. Below 2^14: the variances are limited to 512 and, with them,
// the covariances; the information of a period to 8, and that of the periods before makes up half a variance at most
// (gain_is_old), or what 512 units of speed or load make of one in 12 periods.
static gain_t times_information(const known_t* n, int32_t x_a_q20, int32_t x_s_q20) {
  const gain_t g = {q_mul_add_floor(n->aa_q21, x_a_q20, n->as_q21, x_s_q20, 25),
                    q_mul_add_floor(n->as_q21, x_a_q20, n->ss_q21, x_s_q20, 25)};
  return g;
}

// Row of P (1 + I P)^-1, Q20; inverse: the four elements of (1 + I P)^-1, Q24, those across with the other sign.
static gain_t gain_row(const int32_t inverse[4], int32_t p_a, int32_t p_s) {
  const gain_t k = {q_mul_sub(p_a, inverse[0], p_s, inverse[2], 24), q_mul_sub(p_s, inverse[3], p_a, inverse[1], 24)};
  return k;
}

static int32_t positive(int32_t variance) { return q_max(variance, 16); }

// Takes a variance back to its limit, and its two covariances with it: else a correlation would exceed one while a
// state is not observed, and the covariances would grow until they overflow.
static void limit(int32_t* variance, int32_t* covariance1, int32_t* covariance2) {
  if (*variance <= DEVIATION_VARIANCE_MAX) return;
  // 1 - excess / (2 limit), at most sqrt(limit / variance), as Q30: the limit is 2^29.
  const int32_t keep_q30 = 1073741824L - q_min(*variance - DEVIATION_VARIANCE_MAX, DEVIATION_VARIANCE_MAX);
  *covariance1 = q_mul(*covariance1, keep_q30, 30);
  *covariance2 = q_mul(*covariance2, keep_q30, 30);
  *variance = DEVIATION_VARIANCE_MAX;
}

// With what has been gathered.
static void take_information(deviation_observer_t* s) {
  deviation_gathered_t* const n = &s->gathered;
  const known_t known = {n->aa_q21, q_sat64(q_shr64(n->as_q24, 3)), n->ss_q21};
  const gain_t ga = times_information(&known, s->p_aa, s->p_as);
  const gain_t gs = times_information(&known, s->p_as, s->p_ss);
  const gain_t gl = times_information(&known, s->p_al, s->p_sl);
  // 1 + I P = [1 + ga.a, gs.a; ga.s, 1 + gs.s], Q16.
  const int32_t m_aa = q_add_sat(ga.a, 65536L);
  const int32_t m_ss = q_add_sat(gs.s, 65536L);
  const int32_t det_q12 = q_max(q_mul_sub_sat(m_aa, m_ss, gs.a, ga.s, 20), 4096);
  const int32_t per_det_q30 = qc_over(4096, q_invert(det_q12), 30);
  const int32_t inverse[4] = {q_mul_sat(m_ss, per_det_q30, 22), q_mul_sat(gs.a, per_det_q30, 22),
                              q_mul_sat(ga.s, per_det_q30, 22), q_mul_sat(m_aa, per_det_q30, 22)};
  const gain_t ka = gain_row(inverse, s->p_aa, s->p_as);
  const int32_t p_ss = q_mul_sub(s->p_ss, inverse[3], s->p_as, inverse[1], 24);
  const gain_t kl = gain_row(inverse, s->p_al, s->p_sl);
  // The rows are the new covariance itself; only the load's variance, which nothing measures, is left.
  s->p_aa = positive(ka.a);
  s->p_as = q_within_bits(ka.s, DEVIATION_VARIANCE_BITS);
  s->p_ss = positive(p_ss);
  s->p_al = q_within_bits(kl.a, DEVIATION_VARIANCE_BITS);
  s->p_sl = q_within_bits(kl.s, DEVIATION_VARIANCE_BITS);
  s->p_ll = positive(q_sub_sat(s->p_ll, q_mul_add(s->p_al, gl.a, s->p_sl, gl.s, 16)));
  limit(&s->p_aa, &s->p_as, &s->p_al);
  limit(&s->p_ss, &s->p_as, &s->p_sl);
  limit(&s->p_ll, &s->p_al, &s->p_sl);
  n->aa_q21 = 0;
  n->as_q24 = 0;
  n->ss_q21 = 0;
  n->periods = 0;
}

void deviation_covariance_renew(deviation_observer_t* s, const deviation_observer_config_t* c, bool suspected) {
  predict_covariance(s);
  admit_load_change(s, c, suspected);
  take_information(s);
}

#include "estimators/deviation_observer.h"

#include "estimators/deviation_covariance.h"
#include "estimators/deviation_information.h"
#include "hal/qmath/qcall.h"

#define ONE_Q20 1048576L
#define BAM_PER_UNIT_Q7 1367130551L         // 2^-6 rad
#define BPP_PER_UNIT_Q12 ANGLE_BAM_PER_RAD  // 2^-12 rad per period
#define ACCEL_Q8_PER_UNIT 667544L           // 2^-18 rad per period^2
#define ANGLE_VARIANCE (128L * ONE_Q20)
#define SPEED_VARIANCE (64L * ONE_Q20)
#define LOAD_VARIANCE (64L * ONE_Q20)
#define STANDING_VARIANCE (ONE_Q20 / 4)  // 1.2 rad/s
#define NOISE_SHARE 3                    // the noise is that of a window of a third of the period
#define OUTLIER 192L           // times the noise in a window as long as the period, its share in a shorter one
#define SCORE_BIAS_MIN 40      // a bias of 0.4 units of angle, a third of a degree; Q24 to Q20
#define LAG_MAX_Q20 16777216L  // 16 units of time: 102 ms
#define MEAN_SHIFT 5u
#define POWER_SHIFT 8u
#define POWER_START 419430L  // 0.05: nothing is suspected before the power is known
#define HALF_Q9 256L
#define PERIODS_DUE 7L
#define PERIODS_MAX 12L       // the covariance is renewed at the latest
#define LEFT_PERIODS_MAX 15L  // nobody takes what is left: it begins anew

// N m in 10 ms -> variance per period: acceleration in own units is accel (bpp per N m) / 2607.6; a random walk reaches
// its 10 ms value in 100 periods.
static int32_t load_variance_q20(const machine_model_t* m, int32_t load_rate_q20) {
  const int32_t units_q12 = qc_mul_sat(qc_mul_sat(m->accel_q12, load_rate_q20, 20), 6587625L, 34);
  return q_max(qc_mul_sat(units_q12, units_q12, 4) / 100, 1);
}

void deviation_observer_design(deviation_observer_config_t* c, const machine_model_t* m,
                               const deviation_observer_tuning_t* t) {
  const int32_t noise_q20 = q_max(t->noise_q20, 1049);
  c->weight_q8 = q_square_sat(q_div(ONE_Q20, noise_q20, 20), 32) / NOISE_SHARE;
  c->limit_q19 = noise_q20 * (OUTLIER / 2);
  c->load_noise_q20 = load_variance_q20(m, t->load_rate_q20);
  c->load_noise_quiet_q20 = q_min(load_variance_q20(m, t->load_rate_quiet_q20), c->load_noise_q20);
  c->load_step_q20 = q_min(load_variance_q20(m, t->load_step_q20), DEVIATION_VARIANCE_MAX / 200) * 100;
  c->moving_step_q20 = t->steps_at_speed ? 4 * q_min(c->load_step_q20, DEVIATION_VARIANCE_MAX / 8) : 0;
  c->cogging.crawl_bpp = q_max(t->crawl_bpp, 1);
  c->per_crawl = q_invert(2 * c->cogging.crawl_bpp);
}

void deviation_observer_preset(deviation_observer_t* s, uint32_t angle_bam, int32_t speed_bpp, int32_t load_accel_q8) {
  int32_t* const all = (int32_t*)(void*)s;  // a copy to take them from would be as long as they are
  for (uint16_t k = 0; k < sizeof *s / sizeof *all; k++) all[k] = 0;
  s->p_aa = ANGLE_VARIANCE;
  s->p_ss = SPEED_VARIANCE;
  s->p_ll = LOAD_VARIANCE;
  s->score_power_q23 = POWER_START;
  s->angle_bam = angle_bam;
  s->speed_bpp = q_limit(speed_bpp, MACHINE_SPEED_END_BPP);
  s->load_accel_q8 = load_accel_q8;
}

void deviation_observer_stands(deviation_observer_t* s) {
  s->speed_bpp = 0;
  s->p_ss = STANDING_VARIANCE;
  s->p_as = 0;
  s->p_sl = 0;
}

// The mean of white scores over 32 periods has 1/63 of their power: five standard deviations are 0.63 of its root, and
// noise has them once in five minutes. A longer mean would see smaller loads, and 5 N m a millisecond later. The power
// is measured, not the information's word for it: it holds whatever noise the observer was configured with.
static void follow_scores(deviation_observer_t* s, const information_t* n) {
  s->mean_score_q20 = q_follow_halves(s->mean_score_q20, n->a, MEAN_SHIFT);
  // Neither square nor power is below 0: their difference stays in 31 bits. What the shift leaves counts later: short
  // windows have a power of 100 in Q23, all of which would be lost.
  s->score_power_q23 = q_follow_remainder(s->score_power_q23, q_square_sat(n->a, 17), POWER_SHIFT, &s->score_remainder);
}

static bool scores_suggest_step(const deviation_observer_t* s, const information_t* n) {
  return q_square_sat(s->mean_score_q20, 17) > s->score_power_q23 / 5 * 2 &&
         q_abs_sat(s->mean_score_q20) > n->aa / SCORE_BIAS_MIN;
}

static void predict(deviation_observer_t* s, const deviation_observer_config_t* c, int32_t torque_accel_q8) {
  const int32_t load_q8 =
      q_add_sat(s->load_accel_q8, cogging_load(&s->cogging, &c->cogging, s->angle_bam, s->speed_bpp));
  const int32_t change_q8 = q_sat64((int64_t)torque_accel_q8 - load_q8 + s->speed_remainder_q8);
  const int32_t change = q_shr(change_q8, 8);
  s->angle_bam += (uint32_t)(s->speed_bpp + q_shr(change, 1));
  s->speed_bpp += change;
  s->speed_remainder_q8 = (int32_t)((uint32_t)change_q8 & 255u);
}

static int32_t scored(int32_t k_a, int32_t k_s, const information_t* n) {
  return q_sat64(q_shr64(q_mac(q_product(k_a, n->a), k_s, n->s), 20));
}

static void correct(deviation_observer_t* s, const information_t* n) {
  s->angle_bam += (uint32_t)q_mul_hi(scored(s->p_aa, s->p_as, n), BAM_PER_UNIT_Q7) * 32u;
  s->speed_bpp = q_limit(s->speed_bpp + q_mul_hi(scored(s->p_as, s->p_ss, n), BPP_PER_UNIT_Q12), MACHINE_SPEED_END_BPP);
  const int32_t load_q8 = -q_mul_floor(scored(s->p_al, s->p_sl, n), ACCEL_Q8_PER_UNIT, 20);
  s->load_accel_q8 = q_add_sat(s->load_accel_q8, load_q8);
}

// Eight periods of as much information as a period may have: 64 of them stay in 31 bits. Across it is as bounded, but
// no interval shows that, and it has 64. The digit that is lost is a gain of 6e-5 at the most.
static void gather(deviation_gathered_t* g, const information_t* n) {
  g->aa_q21 += q_shr(n->aa, 3);
  g->as_q24 += n->as;
  g->ss_q21 += q_shr(n->ss, 3);
}

// Beyond a half the gain as it is would correct too much. Nor is an angle waited with that is not known: with zero
// vectors alone at rest it would drift by 6 degrees in 2 s instead of one.
static bool gain_is_old(const deviation_observer_t* s, bool can_wait) {
  if (s->gathered.periods >= PERIODS_MAX) return true;
  return !can_wait && (deviation_observer_learnt_q9(s) > HALF_Q9 || !deviation_observer_is_sure(s));
}

bool deviation_observer_is_due(const deviation_observer_t* s) {
  return s->load_is_new || s->gathered.periods >= PERIODS_DUE;
}

// A load that steps is not waited with for long, nor is what it does to the covariance in the 11 ms behind it.
static void note_load(deviation_observer_t* s, const deviation_observer_config_t* c, bool suspected) {
  const bool looks_out = c->moving_step_q20 > 0 || q_abs_sat(s->speed_bpp) <= c->cogging.crawl_bpp;
  s->load_step_suspected =
      s->load_step_suspected || (suspected && looks_out && s->noise_boost_q30 < DEVIATION_BOOST_OVER_Q30);
  s->load_is_new = s->load_step_suspected || s->noise_boost_q30 > DEVIATION_BOOST_AGAIN_Q30;
}

static const deviation_residual_t no_residual = {0, 0, 0, 0};
static const information_t no_information = {0, 0, 0, 0, 0};

bool deviation_take_mean_residual(deviation_residual_t* left, dq_t* residual_q20, int32_t* span_ticks,
                                  int32_t* periods) {
  const deviation_residual_t sum = *left;
  *left = no_residual;
  if (sum.span_ticks <= 0) return false;
  const int32_t per_span_q17 = DEVIATION_PERIOD_Q17 / sum.span_ticks;
  residual_q20->d = q_sat64(q_shr64(q_product(sum.d_q17, per_span_q17), 14));
  residual_q20->q = q_sat64(q_shr64(q_product(sum.q_q17, per_span_q17), 14));
  *span_ticks = sum.span_ticks / q_max(sum.periods, 1);
  *periods = sum.periods;
  return true;
}

static void leave(deviation_residual_t* left, const information_sums_t* n) {
  if (left->periods >= LEFT_PERIODS_MAX) *left = no_residual;
  left->d_q17 += n->e_q17.d;
  left->q_q17 += n->e_q17.q;
  left->span_ticks += n->span_ticks;
  left->periods++;
}

static void refresh(deviation_observer_t* s, const machine_model_t* m, dq_t current_q18) {
  const dq_t current_q20 = {current_q18.d * 4, current_q18.q * 4};
  s->sensitivity = deviation_sensitivity(m, machine_speed_rad_q30(s->speed_bpp), current_q20);
  s->is_sensitive = true;
}

static information_t look(deviation_observer_t* s, const deviation_observer_config_t* c, const estimator_input_t* in) {
  information_sums_t sums = {0, 0, {0, 0}, {0, 0}, 0};
  deviation_change_t seen[ESTIMATOR_WINDOWS];
  const dq_t current_q18 = deviation_see(in, s->angle_bam, s->speed_bpp, seen);
  // What the first period says counts only where the sensitivities were asked for beside it.
  const bool counts = s->is_sensitive || in->refresh;
  if (in->refresh || !s->is_sensitive) refresh(s, in->model, current_q18);
  for (uint16_t k = 0; k < in->window_count; k++) {
    const estimator_window_t* const w = &in->windows[k];
    if (!c->zero_vectors_only || w->zero_vector) information_collect(&sums, c->limit_q19, &s->sensitivity, w, &seen[k]);
  }
  leave(&s->residual, &sums);
  if (in->regress) {
    regression_evaluate(&s->regression, seen, in);
    s->regressed_bam = s->angle_bam;
  }
  return counts ? information_of(&sums, c, s->sensitivity.h_speed_q20) : no_information;
}

// The observed load follows its cause with a delay, the gain of the speed over that of the load: the ratio of their
// covariances with the angle. Where the angle is not known, as with zero vectors at rest, there is no wave to be seen.
void deviation_observer_learn(deviation_observer_t* s, const deviation_observer_config_t* c) {
  const bool idle = !s->cogging.active && s->cogging.order == c->cogging.order;
  if (idle || !deviation_observer_is_sure(s)) return;
  const int32_t lag_q20 = q_min(qc_over(q_abs_sat(s->p_as), q_invert(q_abs_sat(s->p_al)), 20), LAG_MAX_Q20);
  const uint32_t turned_bam = (uint32_t)q_mul_sat(s->speed_bpp, lag_q20, 14);  // a unit of time is 64 periods
  const cogging_seen_t seen = {s->angle_bam - turned_bam, s->speed_bpp, s->load_accel_q8};
  const int32_t taken_q8 = cogging_learn(&s->cogging, &c->cogging, &seen);
  s->load_accel_q8 = q_sub_sat(s->load_accel_q8, taken_q8);
}

estimator_output_t deviation_observer_step(deviation_observer_t* s, const deviation_observer_config_t* c,
                                           const estimator_input_t* in) {
  information_t n = no_information;
  predict(s, c, in->torque_accel_q8);
  if (in->window_count > 0u) {
    n = look(s, c, in);
    gather(&s->gathered, &n);
  }
  s->gathered.periods++;
  follow_scores(s, &n);
  const bool suspected = scores_suggest_step(s, &n);
  note_load(s, c, suspected);
  if (in->renew || gain_is_old(s, in->busy)) {
    deviation_covariance_renew(s, c, suspected || s->load_step_suspected);
    s->load_step_suspected = false;
  }
  correct(s, &n);
  const int32_t certainty = 32767 - q_shr(s->p_aa, 12);
  const int32_t load_q8 = q_add_sat(s->load_accel_q8, s->cogging.now_q8);
  const estimator_output_t out = {s->angle_bam, s->speed_bpp, load_q8, q_max(certainty, 0)};
  return out;
}

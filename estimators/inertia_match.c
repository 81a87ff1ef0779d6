#include "estimators/inertia_match.h"

#include "control/frame.h"
#include "hal/qmath/qcall.h"

#define ONE_Q24 16777216L
#define QUIET_MS 20u
#define RUN_UP_MS 1000u
#define SETTLE_MS 100u
#define FIRST_TURN (ONE_Q24 / 4)
#define LAST_TURN (16 * ONE_Q24)
#define TURN_END 1073741824L           // 64 turns
#define LOWEST_Q24 (ONE_Q24 / 8 * 3)   // inertia 2.7 times the nominal one
#define HIGHEST_Q24 (ONE_Q24 / 2 * 5)  // 0.4 times
#define BASE_SHIFT 4u

// One by one: a constant to copy would be as long as the memory itself.
void inertia_match_reset(inertia_match_t* s) {
  s->ratio_q24 = ONE_Q24;
  s->phase = INERTIA_REST;
  s->ms = 0;
  s->quiet_ms = 0;
  s->reference_bpp = 0;
  s->base_q8 = 0;
  s->start_base_q8 = 0;
  s->before_q24 = 0;
  s->mean_q8 = 0;
  s->speed0_bpp = 0;
  s->gained_bpp = 0;
  s->last_gained_bpp = 0;
  s->expected = 0;
  s->turned = 0;
  s->next = 0;
  s->angle_bam = 0;
}

static void enter(inertia_match_t* s, inertia_phase_t phase) {
  s->phase = phase;
  s->ms = 0;
}

static void begin(inertia_match_t* s, const inertia_seen_t* in) {
  enter(s, INERTIA_RUN_UP);
  s->start_base_q8 = s->base_q8;
  s->before_q24 = s->ratio_q24;
  s->speed0_bpp = in->speed_bpp;
  s->gained_bpp = 0;
  s->last_gained_bpp = 0;
  s->expected = 0;
  s->turned = 0;
  s->next = FIRST_TURN;
}

static void integrate(inertia_match_t* s, const inertia_seen_t* in, int32_t periods) {
  const int32_t way = q_shr(angle_diff_bam(in->angle_bam, s->angle_bam), 8);
  s->turned = qc_add_sat(s->turned, way - q_shr(s->speed0_bpp, 8) * periods);
  s->expected = qc_add_sat(s->expected, q_shr(s->last_gained_bpp / 2 + s->gained_bpp / 2, 8) * periods);
  s->last_gained_bpp = s->gained_bpp;
}

// What was integrated becomes what the new ratio lets expect.
static int32_t change(inertia_match_t* s, int32_t factor_q24) {
  const int32_t next_q24 = q_clamp(qc_mul_sat(s->ratio_q24, factor_q24, 24), LOWEST_Q24, HIGHEST_Q24);
  const int32_t given_q24 = q_clamp(q_div(next_q24, s->ratio_q24, 24), ONE_Q24 / 8, 8 * ONE_Q24);
  s->ratio_q24 = next_q24;
  s->base_q8 = qc_mul_sat(s->base_q8, given_q24, 24);
  s->start_base_q8 = qc_mul_sat(s->start_base_q8, given_q24, 24);
  s->mean_q8 = qc_mul_sat(s->mean_q8, given_q24, 24);
  s->gained_bpp = qc_mul_sat(s->gained_bpp, given_q24, 24);
  s->last_gained_bpp = s->gained_bpp;
  s->expected = qc_mul_sat(s->expected, given_q24, 24);
  return given_q24;
}

static int32_t judge(inertia_match_t* s, const inertia_seen_t* in, int32_t periods) {
  s->mean_q8 = qc_shl_sat(s->gained_bpp / ((int32_t)s->ms * periods), 8);
  if (qc_abs_sat(s->turned) < s->next || (s->turned < 0) != (s->expected < 0)) return ONE_Q24;
  s->next *= 4;
  if (qc_abs_sat(s->mean_q8) < in->least_accel_q8) return ONE_Q24;
  const int32_t factor_q24 = q_div(qc_abs_sat(s->turned), q_max(qc_abs_sat(s->expected), 1), 24);
  return (qc_abs_sat(factor_q24 - ONE_Q24) > ONE_Q24 / 16) ? change(s, factor_q24) : ONE_Q24;
}

static int32_t run_up(inertia_match_t* s, const inertia_seen_t* in, int32_t periods) {
  integrate(s, in, periods);
  const bool far = qc_abs_sat(s->turned) > TURN_END || qc_abs_sat(s->expected) > TURN_END || s->next > LAST_TURN;
  if (s->quiet_ms > 0u || far || s->ms > RUN_UP_MS) {
    enter(s, INERTIA_SETTLE);
    return ONE_Q24;
  }
  return judge(s, in, periods);
}

// Steady again: the load that was balanced then must be that of before.
static int32_t settle(inertia_match_t* s) {
  if (s->ms < SETTLE_MS || s->quiet_ms < SETTLE_MS) return ONE_Q24;
  enter(s, INERTIA_REST);
  if (s->ratio_q24 == s->before_q24) return ONE_Q24;
  const bool same = qc_abs_sat(qc_sub_sat(s->base_q8, s->start_base_q8)) <= qc_abs_sat(s->mean_q8) / 4;
  return same ? ONE_Q24 : change(s, q_div(s->before_q24, s->ratio_q24, 24));
}

int32_t inertia_match_step(inertia_match_t* s, const inertia_seen_t* in, int32_t periods) {
  const bool moves = in->reference_bpp != s->reference_bpp;
  const bool reached = q_abs_sat(q_sub_sat(in->reference_bpp, in->speed_bpp)) < in->still_bpp;
  const bool rested = s->quiet_ms >= QUIET_MS;
  int32_t factor_q24 = ONE_Q24;
  s->reference_bpp = in->reference_bpp;
  s->quiet_ms = (moves || !reached) ? 0u : (uint16_t)q_min((int32_t)s->quiet_ms + 1, 10000);
  s->ms = (uint16_t)q_min((int32_t)s->ms + 1, 10000);
  if (s->phase == INERTIA_RUN_UP) {
    factor_q24 = run_up(s, in, periods);
  } else {
    if (s->quiet_ms > 0u) s->base_q8 = q_follow(s->base_q8, in->torque_accel_q8, BASE_SHIFT);
    if (s->phase == INERTIA_SETTLE) factor_q24 = settle(s);
    if (s->phase == INERTIA_REST && moves && rested) begin(s, in);
  }
  s->angle_bam = in->angle_bam;
  return factor_q24;
}

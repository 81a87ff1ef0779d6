#include "control/if_start.h"

#include "hal/qmath/qcall.h"

#define ANGLE_80_DEG 954437177L
#define SHIFT_MAX_BAM ((int32_t)ANGLE_BAM_EIGHTH_TURN)
#define MEAN_SHIFT 10u               // 100 ms
#define SWING_SHIFT 7u               // 13 ms
#define TURNING_MOST_Q16 655360000L  // 10 kV, more than any link has: the mean keeps room for its sign
#define FILTER_LEAST 3u
#define FILTER_MOST 8u
#define AWAY_SHARE 16      // times least_q16, an eighth of the EMF at the last speed: twice that
#define AWAY_MS 50         // a change of current takes less
#define SETTLE_PERIODS 40  // 7/a of the current control at 1800 rad/s
#define SETTLE_SHIFT 3u    // 0.8 ms

// Lq I/(lambda w0) in periods, as the next power of two.
static uint16_t filter_shift(const if_start_config_t* c, const machine_model_t* m) {
  const int32_t ratio_q12 = q_div(qc_mul_sat(m->lq_q30, c->current_q20, 22), m->flux_q28, 12);
  const int32_t periods = qc_mul_sat(ratio_q12, c->damping_periods, 12);
  uint16_t n = FILTER_LEAST;
  while (n < FILTER_MOST && (1L << n) < periods) n++;
  return n;
}

bool if_start_design(if_start_config_t* c, const machine_model_t* m) {
  c->step_bpp = q_max(c->step_bpp, 1);
  // Acceleration at a right angle, bpp per period: (w0 T)^2 in units of 2 pi / 2^32.
  const int32_t torque_q16 = qc_mul(m->torque_q24, c->current_q20, 28);
  const int32_t accel_bpp = qc_mul_sat(torque_q16, m->accel_q12, 28);
  c->damping_periods = (int32_t)q_sqrt64((uint64_t)(ANGLE_BAM_PER_RAD / q_max(accel_bpp, 1)));
  c->filter_shift = filter_shift(c, m);
  c->follow_bpp = q_div(2 * ANGLE_BAM_PER_RAD, c->damping_periods, 0);
  // w = v / lambda: rad per period of v over lambda/T, as binary angle.
  c->per_emf_q4 = q_div(ANGLE_BAM_PER_RAD, m->emf_q16, 20);
  c->reactance_q47 = q_div(m->ld_q16, ANGLE_BAM_PER_RAD, 31);
  c->resistance_q24 = m->nominal_rs_q24;
  c->least_q16 = q_div(c->speed_bpp / 8, c->per_emf_q4, 20);
  return q_in_range(c->damping_periods, 10, 10000);
}

void if_start_begin(if_start_t* s, const if_start_config_t* c, uint32_t angle_bam, bool backward) {
  static const if_start_t fresh = {0};
  *s = fresh;
  s->end_bpp = backward ? -c->speed_bpp : c->speed_bpp;
  s->vector_bam = backward ? angle_bam + ANGLE_BAM_QUARTER_TURN : angle_bam - ANGLE_BAM_QUARTER_TURN;
  s->angle_bam = s->vector_bam;
}

void if_start_begin_turning(if_start_t* s, const if_start_config_t* c, uint32_t angle_bam, int32_t current_q20,
                            int32_t speed_bpp) {
  if_start_begin(s, c, angle_bam, speed_bpp < 0);
  s->took_over = true;
  s->vector_bam = angle_bam;
  s->angle_bam = angle_bam;
  s->current_q20 = current_q20;
  s->tick = c->align_periods;
  s->speed_bpp = speed_bpp;
  s->agreed = -SETTLE_PERIODS;
}

void if_start_turn_to(if_start_t* s, const if_start_config_t* c, int32_t target_bpp) {
  s->end_bpp = q_limit(target_bpp, c->speed_bpp);
}

// At rest it points a quarter turn behind first: a rotor that is half a turn away from one of them is not from the
// other. It is led there, and does not swing as it would behind a jump.
static void step_alignment(if_start_t* s, const if_start_config_t* c) {
  const int32_t half = c->align_periods / 2;
  const int32_t lead = half / 2;
  const int32_t passed = s->tick - half;
  if (s->tick < half) s->current_q20 = c->current_q20 / half * s->tick;
  if (s->tick == half) s->current_q20 = c->current_q20;
  if (passed >= 0 && passed < lead) {
    const int32_t step = (int32_t)ANGLE_BAM_QUARTER_TURN / lead;
    s->vector_bam += (uint32_t)((s->end_bpp < 0) ? -step : step);
  }
}

static void step_turning(if_start_t* s, const if_start_config_t* c) {
  s->speed_bpp = q_clamp(s->end_bpp, s->speed_bpp - c->step_bpp, s->speed_bpp + c->step_bpp);
  s->vector_bam += (uint32_t)s->speed_bpp;
}

// The EMF's own mean direction: along it is, to first order, the rotor's speed alone, whatever the lag. Near standstill
// it is that of no lag. A vector that begins to turn the other way turns the EMF over.
static void renew_direction(if_start_t* s, const if_start_config_t* c) {
  const int16_t sign = (s->speed_bpp < 0) ? -1 : 1;
  if (sign + s->sign == 0) {
    s->mean_q16.d = -s->mean_q16.d;
    s->mean_q16.q = -s->mean_q16.q;
  }
  s->sign = sign;
  const int32_t d = sign * s->mean_q16.d;
  const int32_t q = qc_add_sat(sign * s->mean_q16.q, c->least_q16);
  const int32_t length = q_hypot(d, q);
  s->per_emf_q4.d = qc_mul(q_div(d, length, 30), c->per_emf_q4, 30);
  s->per_emf_q4.q = qc_mul(q_div(q, length, 30), c->per_emf_q4, 30);
}

static dq_t emf_of(const if_start_t* s, dq_t voltage_q16) {
  const dq_t emf_q16 = {voltage_q16.d - s->own_q16.d, voltage_q16.q - s->own_q16.q};
  return emf_q16;
}

void if_start_renew(if_start_t* s, const if_start_config_t* c, dq_t voltage_q16) {
  renew_direction(s, c);
  s->own_q16.d = qc_mul_sat(c->resistance_q24, s->current_q20, 28);
  const int32_t turning_q16 = qc_mul_sat(qc_mul_sat(c->reactance_q47, s->current_q20, 31), s->speed_bpp, 20);
  s->own_q16.q = q_limit(turning_q16, TURNING_MOST_Q16);
  if (!s->took_over || if_start_is_up(s, c)) return;
  const dq_t emf_q16 = emf_of(s, voltage_q16);
  const int32_t across_q16 = frame_largest(emf_q16.d, emf_q16.q);
  s->waited = (across_q16 / AWAY_SHARE > c->least_q16) ? q_min(s->waited, 0) - 1 : 0;
}

// While a current settles, its inductance and the drop that it has not yet are no speed: the means follow within eight
// periods, and the vector stays where it was put.
static void damp(if_start_t* s, const if_start_config_t* c, dq_t voltage_q16) {
  const bool settling = s->agreed < 0;
  const uint16_t slow = settling ? SETTLE_SHIFT : MEAN_SHIFT;
  const bool follows = !settling && !q_in_range(s->speed_bpp, -c->follow_bpp, c->follow_bpp);
  const uint16_t swing = follows ? SWING_SHIFT : slow;
  const dq_t emf_q16 = emf_of(s, voltage_q16);
  s->mean_q16.d = qc_follow(s->mean_q16.d, emf_q16.d, swing);
  s->mean_q16.q = qc_follow(s->mean_q16.q, emf_q16.q, swing);
  const int32_t seen = q_mul_add_sat(s->per_emf_q4.d, emf_q16.d, s->per_emf_q4.q, emf_q16.q, 20);
  s->rotor_bpp = qc_follow(s->rotor_bpp, seen, c->filter_shift);
  s->mean_bpp = qc_follow(s->mean_bpp, settling ? seen : s->rotor_bpp, slow);
  if (s->agreed < 0) {
    s->rotor_bpp = s->mean_bpp;
    s->agreed++;
  }
  const int32_t fast = qc_sub_sat(s->rotor_bpp, s->mean_bpp);
  const int32_t shift = q_clamp(qc_mul_sat(fast, 2 * c->damping_periods, 1), -SHIFT_MAX_BAM, SHIFT_MAX_BAM);
  s->angle_bam = s->vector_bam - (uint32_t)shift;
}

if_start_result_t if_start_step(if_start_t* s, const if_start_config_t* c, dq_t voltage_q16, uint32_t seen_bam,
                                int32_t seen_bpp) {
  if (s->tick < c->align_periods) s->tick++;
  if (s->tick < c->align_periods) {
    step_alignment(s, c);
  } else {
    step_turning(s, c);
  }
  damp(s, c, voltage_q16);
  if (s->agreed < 0) return IF_START_PENDING;
  if (!if_start_is_up(s, c)) return (s->waited < -AWAY_MS) ? IF_START_FAILED : IF_START_PENDING;
  const bool near = qc_abs_sat(angle_diff_bam(s->vector_bam, seen_bam)) < ANGLE_80_DEG &&
                    qc_abs_sat(qc_sub_sat(seen_bpp, s->speed_bpp)) < c->speed_bpp / 4;
  s->agreed = near ? (int16_t)(s->agreed + 1) : 0;
  if (s->agreed >= IF_START_AGREED) return IF_START_TAKEN_OVER;
  s->waited++;
  // Two returns, so that the range of what is waited stays known where the step is read (tests/prove/control.c).
  if (s->waited > c->wait_periods) return IF_START_FAILED;
  return IF_START_PENDING;
}

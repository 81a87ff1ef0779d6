// DC staircase along the d-axis: stator resistance, device drop and the error of the assumed dead time.
//
// i_d makes no torque, so the shaft stays. At each level two independent equations hold for the d-axis, with the drop's
// direction factor F (what 1 V in every phase, signed with its current, gives along d; 1.33 at a multiple of 60 deg):
//   the voltage command:  v = R i + (drop error + dead-time error * Vdc / T) F     because the command passes the edges
//   the windows:          -residual / Yd = (R - R model) i + (drop error) F        because they see no edge
// "Error" is what is missing in the drive's own compensation (svpwm/dead_time.h), whose form is thus the form of the
// fit. The command's mean is quiet: it gives R, and drop and edges together. The difference of the two gives the edges,
// noisier, because the windows are, but with no resistance in it.
// The pair of windows is under opposite vectors, so the mean link voltage and the error of Yd fall out of the sum. What
// does not is the link's sag: it falls under one vector and rises under the other, and a window is not in the middle of
// its vector. The link samples at the ends of the two windows tell by how much.
//
// Levels: from 40 % to the whole current limit, but from where the ripple changes no current's sign on (a phase has at
// least half of i_d, so that is twice the ripple, and a fifth to spare where an eighth of the current is left for the
// line), to where the voltage leaves the pulses opposite windows and the ripple does not trip, and not beyond what a
// level may last without an overload: with the machine cool, a quarter of what the overload's time constant bears. They
// have i_d > 0, which pulls the rotor to where it is held, up to half of where the reluctance takes all of the magnet's
// torque, lambda/(Lq - Ld), for i_q has to hold the shaft. Only where that leaves less than a quarter for the line they
// have i_d < 0 where that leaves more, which pushes the rotor away, up to the field-weakening limit, for the magnets'
// sake. Resistance of winding and of devices cannot be told apart this way: the devices' is kept as it was given.
//
// 2.4 times the ripple is 8/5 U/L for the length of a pulse, the voltage's end U/4 R for the same length: where L/R is
// below 7.3 periods they leave less than an eighth between them, however long a pulse is; the trip or a small current
// limit may do so anywhere. A rotor that follows the current needs no pulses to be seen. There the pulses are those of
// R i alone, which change no current's sign, and the zero vector behind them lasts for most of the period. Its window
// sees R i decay, with no part of the link's and no edge:
//   -residual / Yd = (R - R model) i + (drop error) F      with the window's own current
// That gives R and drop. What the command has beyond it at all levels alike is the edges'; its slope is not R's, for
// the period's end, where the current is controlled, is where the ripple is lowest.

#include "firmware/base/clear.h"
#include "firmware/board/functions.h"
#include "firmware/commissioning/phases.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"

#define SETTLE_PERIODS 600
#define TURN_PERIODS 6u  // in which the excitation comes round
#define TURNS 3u
#define LEVEL_PERIODS 8406  // a multiple of the turns'

// Peak to peak on the d-axis: two thirds of the link for the length of a pulse.
static int32_t ripple_q20(const drive_t* d) {
  const int32_t swing_q20 = qc_mul(d->samples.link_q16, commissioning.model.yd_q30, 26);
  return swing_q20 / 3 * 2 / 100 * (d->config.modulator.pulse_ticks / 100);
}

// A level lasts 0.9 s: the square of its current, of that which may flow for ever, times 0.9 s over the time constant.
static int32_t bearable_q20(void) {
  const int32_t lasting_q20 = board_lasting_current();
  if (lasting_q20 == 0) return INT32_MAX;
  const int32_t share_q8 = (int32_t)q_sqrt32((uint32_t)drive.config.values.overload_time * 18u);  // 2^16 / 4 / 900 ms
  return qc_mul_sat(lasting_q20, q_max(share_q8, 256), 8);
}

// Half of the current along d whose reluctance leaves the magnet no torque.
static int32_t held_q20(void) {
  const machine_model_t* const m = &commissioning.model;
  return q_div(m->flux_q28, m->lq_q30 - m->ld_q30, 21);
}

// Where R i takes a quarter of what the link gives in a pulse. Beyond, the shorter of two pulses is about as short as
// what it differs by from the other.
static int32_t opposite_q20(const drive_t* d) {
  const int32_t volts_q16 = d->samples.link_q16 / 400 * (d->config.modulator.pulse_ticks / 100);
  return q_div(volts_q16, commissioning.model.rs_q24, 28);
}

// With next to no room between the two there are no levels but those under the zero vector. The pulses take the current
// from its mean to either side, saturated by somewhat more: to the trip at most, in the map as well.
static void place(const drive_t* d) {
  staircase_t* const s = &commissioning.staircase;
  const config_values_t* const v = &d->config.values;
  int32_t ripple = ripple_q20(d);
  const int32_t room =
      q_clamp(v->trip_current - ripple - q_shr(ripple, 3), q_shr(v->current_limit, 2), v->current_limit);
  const int32_t limit = q_clamp(q_min(bearable_q20(), opposite_q20(d)), 0, room);
  commissioning.map.most_q20 = room;
  // A rotor without saliency follows: nothing holds it.
  int32_t most = commissioning.uniform ? limit : q_clamp(held_q20(), 0, limit);
  s->held_q20 = most;
  int32_t sign = 1;
  const int32_t weakening = q_min(limit, v->weakening_limit);
  if (weakening > most && ripple > q_shr(most * 5, 4)) {
    most = weakening;
    sign = -1;
  }
  const int32_t largest = most - q_shr(most, 3);
  s->at_zero = commissioning.uniform && ripple / 10 * 24 > largest;
  if (s->at_zero) {
    ripple = 0;
  } else if (ripple > q_shr(most, 1)) {
    sign = 0;
  }
  const int32_t least = q_max(most / 10 * 4, q_min(ripple / 10 * 24, largest));
  s->first_q20 = sign * least;
  s->step_q20 = sign * ((most - least) / (int32_t)(STAIRCASE_LEVELS - 1u));
}

// What one volt of drop in every phase gives along the d-axis, Q20.
static int32_t factor_q20(ab_t current_q20, rotation_t r) {
  return frame_park(dead_time_drop_q16(&commissioning.staircase.one_volt, current_q20), r).d * 16;
}

static void add_period(const drive_t* d, staircase_level_t* l, rotation_t r, dq_t i) {
  q_gather(&l->current, i.d);
  q_gather(&l->command, (int64_t)d->control.command_q16.d * 16);
  q_gather(&l->factor, factor_q20(frame_inverse_park(i, r), r));
  l->periods = qc_add_sat(l->periods, 1);
}

// Difference of the link between the middles of the two windows, from that between their ends, times the voltage along
// d: what the evaluation divides by the link is a voltage along d.
static void add_sag(const drive_t* d, staircase_level_t* l, rotation_t r) {
  const estimator_window_t* const e = d->samples.windows;
  const svpwm_window_t* const p = modulation_sampled(&d->modulation)->windows;
  const sampling_config_t* const c = &d->config.modulator.sampling;
  const int32_t around = c->settle_ticks + c->burst_ticks;
  const int32_t length = p[0].end - p[0].start + around;
  const int32_t middles = e[0].middle_tick - p[0].start + e[1].middle_tick - p[1].start + 2 * c->settle_ticks;
  const int32_t ends = middles + (e[0].span_ticks + e[1].span_ticks) / 2;
  const int32_t share_q15 = (middles - length) * (int32_t)32768 / q_max(ends - length, 1);
  const int32_t at_ends_q16 = d->samples.link_end_q16[0] - d->samples.link_end_q16[1];
  const ab_t quarter_q16 = {q_shr(e[0].voltage_q19.alpha - e[1].voltage_q19.alpha, 5),
                            q_shr(e[0].voltage_q19.beta - e[1].voltage_q19.beta, 5)};
  q_gather(&l->sag, qc_mul_sat(qc_mul(at_ends_q16, share_q15, 15), frame_park(quarter_q16, r).d, 20));
}

static void add_window(const drive_t* d, staircase_level_t* l, uint16_t k) {
  q_gather(&l->residual, commissioning_window(d, k).residual_q20.d);
  l->windows = qc_add_sat(l->windows, 1);
}

// Beside the angle a period has time for one of the sums. By turns of as many periods as the excitation comes round in
// each of them is made of the same patterns.
static void add_one(const drive_t* d, staircase_t* s) {
  staircase_level_t* const l = &s->level[s->index];
  s->turn = (s->turn + 1u < TURNS * TURN_PERIODS) ? (uint16_t)(s->turn + 1u) : 0u;
  if (s->at_zero ? d->samples.count == 0u : !commissioning_has_pair(d)) return;
  const uint16_t last = d->samples.count / 2u;  // of one or two: the zero vector's
  if (s->turn < TURN_PERIODS) {
    const rotation_t r = frame_rotation(d->estimate.selected.angle_bam);
    dq_t i = d->estimate.measured_q20;
    if (s->at_zero) i.d = q_limit(d->estimate.frames[last].current_q18.d, DRIVE_CURRENT_END_Q20 / 4) * 4;
    add_period(d, l, r, i);
    if (!s->at_zero) add_sag(d, l, r);
  } else {
    add_window(d, l, s->at_zero ? last : (uint16_t)(s->turn / TURN_PERIODS - 1u));
  }
}

static void design_one_volt(const drive_t* d) {
  dead_time_config_t* const c = &commissioning.staircase.one_volt;
  *c = d->config.dead_time;
  c->drop_q16 = 65536L;
  dead_time_design(c);
}

// A request that comes while the background level makes the configuration may be lost with it, so it is made again.
static bool has_sampling(const drive_t* d, commissioning_sampling_t how) {
  const bool at_zero = d->config.modulator.pulse_ticks == 0;
  if (at_zero == (how == SAMPLING_AT_ZERO)) return true;
  commissioning_sample(how);
  return false;
}

bool commissioning_climb(drive_t* d) {
  commissioning_t* const c = &commissioning;
  staircase_t* const s = &c->staircase;
  if (c->tick == 0) {
    s->index = 0;
    s->turn = 0;
    s->tick = 0;
    place(d);
    tensor_reset(&c->unsaturated);
    return false;
  }
  if (c->tick == 2) design_one_volt(d);  // not beside the placing of the levels, which is long
  commissioning_hold(d);
  if (s->index >= STAIRCASE_LEVELS) {
    commissioning_set_d(d, 0);
    if (d->control.references.current_q20.d != 0 || !has_sampling(d, SAMPLING_LONGER)) return false;
    s->tick = qc_add_sat(s->tick, 1);
    commissioning_add_still(d);
    return s->tick > SETTLE_PERIODS + 1;
  }
  if (s->tick == 0 && s->at_zero && !has_sampling(d, SAMPLING_AT_ZERO)) return false;
  const bool rests = s->tick == 0 && interlock_is_warm();
  commissioning_set_d(d, rests ? 0 : s->first_q20 + (int32_t)s->index * s->step_q20);
  if (rests) return false;
  staircase_level_t* const l = &s->level[s->index];
  if (s->tick == 0) clear(l, sizeof *l);
  s->tick = qc_add_sat(s->tick, 1);
  if (s->tick > SETTLE_PERIODS) add_one(d, s);
  if (s->tick < SETTLE_PERIODS + LEVEL_PERIODS) return false;
  l->link_q16 = d->samples.link_q16;
  s->index++;
  s->tick = 0;
  return false;
}

// A spin: flux linkage from the EMF, inertia from the torque it takes to change the speed, friction from steady speeds.
//
// Steady low, ramp up, steady high, ramp down, steady low again, stop. The differences between the steady speeds are
// free of what does not turn: drops, dead time, offsets. The ramps begin and end at steady speed, so that lags of the
// estimators do not count: inertia is the momentum that went in, less friction, over the change of speed. A speed is
// what the angle has turned by in that time: the observer's own is off by what it corrects the angle by, period after
// period.
//
// At no load the torque current is less than what tells the dead time, and at the ends of a period, where the pulses
// begin and end, the phases carry next to nothing: what such an edge loses depends on the little that the EMF drives
// beside the pulses. That is a voltage which grows with the speed, and no difference of two speeds is without it: 1 V
// of 37 on a traction motor. So while the voltage is measured, a current flows along d. The phases' currents go through
// zero with it, the edges' errors come as often with the one sign as with the other, and what it leaves itself lies
// along d. It is as much negative as positive, so that Ld is not in the mean, and not always the same, for where it is
// as large as the ripple there are edges without a current again. Currents that stand for a torque are measured behind
// it: with it the reluctance has a torque, and an angle that is off by a little makes torque of it.
//
// A rotor without saliency gets none: what the current leaves along d turns the angle that its EMF shows.

#include "firmware/base/clear.h"
#include "firmware/commissioning/phases.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/start/phases.h"
#include "hal/qmath/qcall.h"

#define SETTLE_PERIODS 4000  // from here on i_d flows,
#define SIGN_PERIODS 8096    // has the other sign,
#define REST_PERIODS 12192   // and does not flow any more
#define LEG_PERIODS 22192    // of which those behind the settling are a station
#define PARTS_SHIFT 13u      // 8192 periods have i_d
#define STILL_PERIODS 3000
#define TURN_PERIODS 14000  // so long a turn's end is waited for: from 129 rpm electrical on it comes
#define RAMP_MS 300         // for the whole speed

typedef enum { LEG_FIRST = 0, LEG_UP = 1, LEG_DOWN = 2, LEG_STOP = 3 } leg_t;

// Of a station with i_d the voltage first, then the torque current; a ramp, and a machine without saliency, have both
// in one.
static void add_period(const drive_t* d, spin_sums_t* s, int32_t turned_bam) {
  const spin_t* const spin = &commissioning.spin;
  const bool apart = spin->part_q20 != 0 && spin->tick >= SETTLE_PERIODS;
  if (!apart || spin->tick < REST_PERIODS) {
    q_gather(&s->speed, turned_bam);
    q_gather(&s->voltage_q, d->control.command_q16.q);
    q_gather(&s->current_d, d->estimate.measured_q20.d);
    s->periods = qc_add_sat(s->periods, 1);
  }
  if (apart && spin->tick < REST_PERIODS) return;
  q_gather(&s->current_q, d->estimate.measured_q20.q);
  s->torque_periods = qc_add_sat(s->torque_periods, 1);
}

// What shows no axis at rest is turned by a current vector first, and comes back with its speed.
static void start_by_vector(drive_t* d) {
  d->source = edition_default_source;  // until the parameters are loaded again
  d->control.target_bpp = 0;
  drive_enter(d, DRIVE_START);
  d->flags.unseen = KNOWN_ROTOR;
  d->flags.behind = DRIVE_COMMISSION;
  start_phases[START_IF_RAMP]->begin(d);
}

// A share of the current limit, but no more than the staircase held the rotor with, and than the magnets bear.
static int32_t most_d_q20(const drive_t* d) {
  const config_values_t* const v = &d->config.values;
  return q_min(q_min(commissioning.staircase.held_q20, v->weakening_limit), q_shr(v->current_limit, 4) * 3);
}

static void begin(drive_t* d) {
  if (!d->flags.spins) {
    drive_bumpless_transfer(d, d->estimate.selected.angle_bam, 0);
    d->control.references.current_q20.q = 0;
  }
  commissioning.spin.begun = true;
  if (!commissioning.uniform) commissioning.spin.part_q20 = q_shr(most_d_q20(d), PARTS_SHIFT);
  drive_begin_spin(d);
  d->flags.frozen = false;
  d->control.target_bpp = d->control.ramp.value;
}

// Once in a millisecond: moves the speed reference towards the leg's; true when it is there. The drive's own ramp may
// be slower still.
static bool approach(drive_t* d) {
  const int32_t most_q8 = q_min(d->config.values.spin_speed, d->config.values.speed_limit);
  const int32_t high = qc_mul_sat(most_q8, d->config.bpp_per_rpm_q8, 16);
  const uint16_t leg = commissioning.spin.leg;
  const int32_t goal = (leg == (uint16_t)LEG_UP) ? high : (leg == (uint16_t)LEG_STOP) ? 0 : high / 3;
  const int32_t step = high / RAMP_MS;
  int32_t* const target = &d->control.target_bpp;
  *target = q_clamp(goal, qc_sub_sat(*target, step), qc_add_sat(*target, step));
  return *target == goal && d->control.ramp.value == goal;
}

// From the most to half of it, and back with the other sign.
static void refer_d(drive_t* d) {
  const int32_t tick = commissioning.spin.tick;
  int32_t parts = 0;
  if (tick >= SETTLE_PERIODS && tick < REST_PERIODS - DRIVE_PERIODS_PER_MS)
    parts = ((tick < SIGN_PERIODS) ? REST_PERIODS : SETTLE_PERIODS) - tick;
  d->control.references.spin_d_q20 = commissioning.spin.part_q20 * parts;
}

// Back to holding the shaft, with the motion that the background level makes of the sums.
static bool hand_back(drive_t* d) {
  commissioning_t* const c = &commissioning;
  if (d->flags.spins) {
    d->flags.spins = false;
    c->solve_motion = true;
    position_preset(d, &d->estimate, d->estimate.selected.angle_bam, 0);
    d->control.references.current_q20.d = 0;
    c->target_bam = d->estimate.selected.angle_bam;
  }
  commissioning_hold(d);
  if (c->solve_motion) return false;
  d->estimate.model.torque_q24 = c->torque_q24;
  d->estimate.model.accel_q12 = c->accel_q12;
  machine_model_follow(&d->estimate.model, 0);
  return true;
}

bool commissioning_spin(drive_t* d) {
  spin_t* const s = &commissioning.spin;
  // Each thing that is long has a period for itself.
  if (commissioning.tick == 0) {
    clear(s, sizeof *s);
    d->control.references.spin_d_q20 = 0;
    if (commissioning.uniform) start_by_vector(d);
    return false;
  }
  if (!s->begun) {
    if (d->flags.spins) d->control.target_bpp = d->control.ramp.value;  // a vector brought it: it turns on meanwhile
    if (start_has_exclusive_slot(d)) begin(d);
    return false;
  }
  if (!d->flags.spins) return hand_back(d);
  if (d->schedule.task == TASK_FIELD) {
    s->arrived = approach(d);
    refer_d(d);
  }
  if (s->leg >= (uint16_t)LEG_STOP) {
    if (commissioning.uniform) {
      commissioning.phase = COMMISSIONING_MAP;  // which wants a shaft that is held
      return true;
    }
    s->tick = qc_add_sat(s->tick, s->arrived ? 1 : 0);
    // The background level comes first.
    if (s->tick > STILL_PERIODS && start_has_exclusive_slot(d)) (void)hand_back(d);
    return false;
  }
  const uint32_t before_bam = s->angle_bam;
  s->angle_bam = d->estimate.selected.angle_bam;
  const int32_t turned_bam = angle_diff_bam(s->angle_bam, before_bam);
  if (s->tick >= SETTLE_PERIODS) {
    add_period(d, &s->station[s->leg], turned_bam);
  } else if (s->leg != (uint16_t)LEG_FIRST) {
    add_period(d, &s->ramp[s->leg - 1u], turned_bam);
  }
  // From the last quarter to the first, it has come round: noise may turn it back from one period to the next. A shaft
  // that does not turn is not waited for for ever, and what was summed up judges itself.
  const bool round = before_bam >> 30 == 3u && s->angle_bam >> 30 == 0u;
  const bool is_end = s->tick == SETTLE_PERIODS - 1 || s->tick == REST_PERIODS - 1 || s->tick == LEG_PERIODS - 1;
  const bool waits = is_end && !round && s->waited < TURN_PERIODS;
  s->waited = waits ? (uint16_t)(s->waited + 1u) : 0u;
  s->tick = qc_add_sat(s->tick, (s->arrived && !waits) ? 1 : 0);
  if (s->tick < LEG_PERIODS) return false;
  s->leg++;
  s->tick = 0;
  s->arrived = false;
  return false;
}

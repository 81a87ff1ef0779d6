// Speed control and field weakening, once a millisecond on a tick of the control interrupt.

#include <stddef.h>

#include "control/brake_limit.h"
#include "control/rise.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"

#define FASTEST_EVEN_BPP 536870912L        // 1250 Hz: beyond every speed
#define PERCENT_OF_SQRT3_INV_Q30 6199251L  // of the largest vector, per volt of the DC link

static int32_t voltage_limit(const drive_t* d) {
  return q_mul(d->samples.link_q16, q_mul(d->config.values.voltage_use, PERCENT_OF_SQRT3_INV_Q30, 16), 30);
}

void drive_weaken_field(const drive_t* d, drive_control_t* c) {
  const field_weakening_input_t in = {d->estimate.selected.speed_bpp,
                                      c->references.current_q20.q,
                                      q_hypot(c->command_q16.d, c->command_q16.q),
                                      voltage_limit(d),
                                      d->config.values.weakening_limit,
                                      d->config.values.weakening_gain};
  field_weakening_step(&c->weakening, &in, &d->estimate.model);
}

void drive_refer_field(const drive_t* d, drive_control_t* c) {
  int32_t bias = (d->estimate.blend.region == BLEND_HIGH) ? 0 : d->config.values.id_low_speed;
  int32_t least = (d->config.values.mtpa == 0) ? 0 : mtpa_current_q20(&d->config.mtpa, c->references.current_q20.q);
  if (d->source->highest_d_q20 != NULL) least = q_min(least, d->source->highest_d_q20(d));
  // A commissioning's spin has the i_d that it asks for.
  if (d->state == DRIVE_COMMISSION) {
    bias = c->references.spin_d_q20;
    least = 0;
  }
  c->references.current_q20.d =
      q_clamp(qc_add_sat(q_min(c->weakening.id_q20, least), bias), -c->current_limit_q20, c->current_limit_q20);
  c->limits &= ~(int32_t)LIMIT_WEAKENING;
  if (c->weakening.id_q20 < 0) c->limits |= LIMIT_WEAKENING;
}

// Current that balances the estimated load. The observers see friction as part of the load; the speed law's own model
// has it too, so it is taken off here.
static int32_t load_current(const drive_t* d) {
  const int32_t speed = d->estimate.selected.speed_bpp;
  const int32_t load_q20 = qc_mul_sat(d->estimate.selected.load_accel_q8, d->estimate.model.torque_per_accel_q24, 20);
  const int32_t friction_q20 = qc_mul_sat(speed, d->config.friction_per_bpp_q40, 20);
  const int32_t torque_q20 = qc_sub_sat(load_q20, friction_q20);
  return qc_over(torque_q20, d->control.per_torque_constant, 24);
}

// A rotor that is found by its saliency is lost with it: the current stays below saliency_current until the EMF tells
// as much, and is all there when the EMF outweighs what the saliency may have become (config/config.c). In between the
// limit rises evenly, so that no step of it makes the current chatter.
static int32_t usable_current(const drive_t* d) {
  const int32_t limit_q20 = d->control.current_limit_q20;
  const int32_t salient_q20 = d->config.salient_q20;
  if (salient_q20 >= limit_q20) return limit_q20;
  const int32_t even_bpp = q_clamp(qc_mul_sat(d->samples.link_q16, d->config.salient_bpp_q4, 20), 1, FASTEST_EVEN_BPP);
  const int32_t freed_bpp = qc_mul_sat(even_bpp, d->config.freed_by_q8, 8);
  const int32_t share_q30 = rise_q30(qc_abs_sat(d->estimate.selected.speed_bpp), even_bpp, freed_bpp);
  return q_mix(salient_q20, limit_q20, share_q30, 30);
}

int32_t drive_current_headroom(const drive_t* d) {
  const int32_t limit = usable_current(d);
  const int32_t id_q20 = d->control.references.current_q20.d;
  if (id_q20 == 0) return limit;
  const int64_t room = (int64_t)limit * limit - (int64_t)id_q20 * id_q20;
  return (room > 0) ? q_min((int32_t)q_sqrt64((uint64_t)room), limit) : 0;
}

static int32_t braking_headroom(const drive_t* d, int32_t headroom_q20) {
  brake_limit_input_t in;
  if (d->samples.link_q16 <= d->config.values.link_regulation) return headroom_q20;
  in.link_q16 = d->samples.link_q16;
  in.start_q16 = d->config.values.link_regulation;
  // The rest of the way to the fault is for noise and for the delay of the loop.
  in.end_q16 =
      d->config.values.link_regulation + (d->config.values.link_maximum - d->config.values.link_regulation) / 3 * 2;
  in.emf_q16 =
      qc_mul_sat(q_abs_sat(machine_speed_rad_q30(d->estimate.selected.speed_bpp)), d->estimate.model.emf_q16, 30);
  in.drop_q16 = qc_mul_sat(d->estimate.model.nominal_rs_q24, d->config.values.current_limit, 28);
  return brake_limit_q20(&in, headroom_q20);
}

// Both follow the reference of i_d.
static void make_torque_constant(const drive_t* d, drive_control_t* c) {
  c->per_torque_constant = q_invert(machine_torque_constant_q24(&d->estimate.model, c->references.current_q20.d));
}

static void make_room(const drive_t* d, drive_control_t* c) {
  c->headroom_q20 = drive_current_headroom(d);
  c->braking_headroom_q20 = braking_headroom(d, c->headroom_q20);
}

// Braking is what acts against the rotation.
static void limit_current(const drive_t* d, speed_controller_input_t* in) {
  const drive_control_t* const c = &d->control;
  in->lowest_q20 = (in->speed_bpp > 0) ? -c->braking_headroom_q20 : -c->headroom_q20;
  in->highest_q20 = (in->speed_bpp < 0) ? c->braking_headroom_q20 : c->headroom_q20;
}

// A shaft that may not be braked as fast as the ramp falls would be left behind by it, and be braked on when it has
// long been commanded to speed up again: the ramp waits.
static bool ramp_waits(const drive_t* d, int32_t target_bpp) {
  if ((d->control.limits & LIMIT_BRAKING) == 0) return false;
  const int32_t value = d->control.ramp.value;
  return (d->estimate.selected.speed_bpp > 0) ? target_bpp < value : target_bpp > value;
}

// At a reference of zero the position is kept, not only the speed: from twice a crawl down it counts as at rest.
static int32_t hold_position(const drive_t* d, drive_control_t* c) {
  const bool at_zero = d->state == DRIVE_RUN && c->target_bpp == 0 && c->ramp.value == 0;
  const bool slow = q_abs_sat(d->estimate.selected.speed_bpp) < 2 * d->config.observer.cogging.crawl_bpp;
  if (!at_zero || !(slow || c->position_hold.holding)) {
    position_hold_release(&c->position_hold);
    return 0;
  }
  return position_hold_step(&c->position_hold, d->estimate.selected.angle_bam, d->config.hold_gain_q30);
}

static void step_ramp(const drive_t* d, drive_control_t* c, speed_controller_input_t* in) {
  const int32_t target = (d->state == DRIVE_STOP) ? 0 : c->target_bpp;
  in->reference_bpp = c->ramp.value;
  ramp_step(&c->ramp, ramp_waits(d, target) ? c->ramp.value : target, d->config.ramp_step_bpp);
  in->reference_step_bpp = c->ramp.step;
  if (d->config.ramp_step_bpp == 0) in->reference_bpp = c->ramp.value;
}

static void note_limits(drive_control_t* c, const speed_controller_input_t* in) {
  const int32_t iq_q20 = c->references.current_q20.q;
  const int32_t room = q_max(in->highest_q20, -in->lowest_q20);
  if (q_abs_sat(iq_q20) >= room) c->limits |= LIMIT_CURRENT;
  const bool at_end = iq_q20 <= in->lowest_q20 || iq_q20 >= in->highest_q20;
  if (at_end && q_abs_sat(iq_q20) < room) c->limits |= LIMIT_BRAKING;
}

static void step_speed(const drive_t* d, drive_control_t* c, bool held) {
  speed_controller_input_t in;
  step_ramp(d, c, &in);
  in.reference_bpp = qc_add_sat(in.reference_bpp, hold_position(d, c));
  c->limits &= ~(int32_t)LIMIT_BRAKING;
  in.speed_bpp = d->estimate.selected.speed_bpp;
  in.load_current_q20 = load_current(d);
  limit_current(d, &in);
  if (held) {
    speed_controller_preset(&c->speed, q_sub_sat(c->references.current_q20.q, in.load_current_q20));
    return;
  }
  c->references.current_q20.q = speed_controller_step(&c->speed, (speed_law_t)d->config.values.speed_law, &in);
  note_limits(c, &in);
}

static void begin_millisecond(const drive_t* d, drive_control_t* c, bool held) {
  c->limits &= ~(int32_t)LIMIT_CURRENT;  // the ramp goes by that of braking; weakening renews its own
  if (drive_is_turning(d)) step_speed(d, c, held);
}

// A commissioning that measures at standstill commands its currents itself.
static bool steers(const drive_t* d) { return d->state != DRIVE_COMMISSION || d->flags.spins; }

void drive_control_speed(const drive_t* d, drive_control_t* c, drive_estimate_t* e) {
  const bool held = hold_is_on(d);
  if (held) c->references.current_q20.q = hold_step_q20(d);
  switch (d->schedule.task) {
    case TASK_SPEED:
      if (drive_is_turning(d)) drive_refer_field(d, c);
      if (steers(d)) make_room(d, c);
      begin_millisecond(d, c, held);
      break;
    case TASK_JUDGE_FIRST:
      if (d->schedule.judges) deviation_observer_learn(&e->observer, &d->config.observer);
      break;
    case TASK_FIELD:
      if (drive_is_turning(d)) drive_weaken_field(d, c);
      break;
    case TASK_JUDGE:
      make_torque_constant(d, c);
      drive_match_inertia(d, e, &c->speed);
      break;
    default:
      break;
  }
}

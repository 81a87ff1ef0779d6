// The start of a shaft that turns: two short circuits tell angle, polarity and speed, then the current loop is closed
// at that speed and watched for a moment before the drive runs.

#include "firmware/start/flying/flying.h"

#include <stddef.h>

#include "firmware/base/clear.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/start/flying/look.h"
#include "firmware/start/phases.h"
#include "hal/qmath/qcall.h"

#define PULSE_MAX 12u          // periods of a short circuit that hardly drives a current
#define LISTEN_FIRST 4u        // periods until the short circuit is what the modulator gives
#define PAUSE_MIN 6            // for the current to die away
#define PAUSE_MAX 600          // 60 ms: 60 degrees at the slowest EMF that counts
#define PAIRS_MAX 4u           // pairs of pulses before giving up
#define STANDING_Q16 196608L   // 3 V: 45 rpm on motor A, beyond what drops and noise can fake
#define FLUX_EMF_Q16 2621440L  // 40 V
#define CATCH_PERIODS 140u
#define ON_TICKS 200              // from the gates' command to the devices
#define STRAY_MAX_BAM 178956971L  // 15 degrees

flying_start_t flying_start;

// These two listen for the next pulse; who else wants to look begins anew.
static bool goes_on(void) { return starting.phase == START_PULSE || starting.phase == START_CATCH; }

static void begin_listen(drive_t* d) {
  if (!goes_on()) {
    clear(&flying_start, sizeof flying_start);
    flying_start.pause = LISTEN_FIRST;
  }
  start_power(d, false);
  d->flags.shorted = true;
  d->flags.caught = false;
  d->flags.unseen = KNOWN_ROTOR;
  d->control.references.closed = false;
  start_enter(START_LISTEN);
}

static start_phase_t step_listen(drive_t* d) {
  (void)d;
  return (starting.tick < flying_start.pause) ? START_GOES_ON : START_PULSE;
}

static void begin_pulse(drive_t* d) {
  flying_begin(&flying_start.pulse);
  start_enter(START_PULSE);
  start_power(d, true);
}

// The next short circuit, after so many periods.
static start_phase_t listen(uint16_t pause) {
  flying_start.pause = pause;
  return START_LISTEN;
}

// The flux that the pulses saw, where it is an eighth or more off the nominal one; a small EMF is mostly error. It
// takes the inverse inductance of the model as it is by now: a machine of other inductances looks like one of another
// flux.
static void take_flux(drive_t* d) {
  machine_model_t* const m = &d->estimate.model;
  const int32_t w_q30 = qc_abs_sat(machine_speed_rad_q30(flying_start.rotor.speed_bpp));
  m->trim.psi_q16 = 0;
  if (flying_start.emf_q16 < FLUX_EMF_Q16) return;  // a pair that fits has a speed that fits its size
  const int32_t nominal_q30 = m->map.points[0].yqq_q30;
  const int32_t now_q30 = nominal_q30 + qc_mul(nominal_q30, m->trim.yqq_q24, 24);
  const int32_t emf_q16 = qc_mul_sat(flying_start.emf_q16, q_div(nominal_q30, now_q30, 24), 24);
  const int32_t off_q16 = qc_sub_sat(q_div(emf_q16, w_q30, 30), m->emf_q16);
  const int32_t eighth_q16 = m->emf_q16 / 8;
  if (qc_abs_sat(off_q16) < eighth_q16) return;
  m->trim.psi_q16 = q_limit(off_q16, 3 * eighth_q16);
}

// The start's clock: tick at which the running period began, from the start of START.
static uint32_t clock_of(const drive_t* d) { return d->periods * (uint32_t)ESTIMATOR_PERIOD_TICKS; }

// The rotor's state, carried on from the second pulse to the running period.
static void close_loop(drive_t* d) {
  flying_rotor_t* const rotor = &flying_start.rotor;
  const int32_t periods_q16 = q_div((int32_t)(clock_of(d) - (uint32_t)rotor->tick), ESTIMATOR_PERIOD_TICKS, 16);
  rotor->angle_bam += (uint32_t)(((int64_t)rotor->speed_bpp * periods_q16) >> 16);
  position_preset_axis(&d->estimate, rotor->angle_bam, rotor->speed_bpp);
  take_flux(d);
  axis_begin(&starting.axis);
  starting.sigma_q8 = rotor->sigma_q8;
  flying_start.learnt = false;
  flying_start.flux_due = false;
  d->flags.shorted = false;
  flying_start.stray = 0;
  d->control.references.closed = true;
  field_weakening_reset(&d->control.weakening);
  drive_weaken_field(d, &d->control);
  drive_refer_field(d, &d->control);
}

// The gates are off already.
static void end_look(drive_t* d, look_outcome_t outcome, int32_t speed_bpp) {
  drive_look_end(outcome, drive_rpm_q16(d, speed_bpp));
  drive_enter(d, DRIVE_READY);
}

static start_phase_t try_again(drive_t* d) {
  flying_start_t* const s = &flying_start;
  starting.tries++;
  s->pulses = 0;
  if (starting.tries < PAIRS_MAX) return listen(PAUSE_MIN);
  if (d->flags.behind == DRIVE_READY) {
    end_look(d, LOOK_UNCLEAR, flying_speed(s->emf_q16, &d->estimate.model));
  } else {
    drive_trip(d, FAULT_POLARITY);
  }
  return START_GOES_ON;
}

static start_phase_t judge_pair(drive_t* d, const flying_emf_t* second) {
  flying_start_t* const s = &flying_start;
  s->emf_q16 = second->size_q16;
  if (!flying_resolve(&s->first, second, &d->estimate.model, &s->rotor)) return try_again(d);
  if (d->flags.behind != DRIVE_READY) return START_CATCH;
  end_look(d, LOOK_TURNS, s->rotor.speed_bpp);
  return START_GOES_ON;
}

static start_phase_t find_no_emf(drive_t* d) {
  if (d->flags.behind != DRIVE_READY) return start_at_standstill(d);
  end_look(d, LOOK_STANDS, flying_speed(STANDING_Q16, &d->estimate.model));
  return START_GOES_ON;
}

// The gates are off again.
static start_phase_t judge_pulse(drive_t* d) {
  flying_start_t* const s = &flying_start;
  const flying_emf_t e = flying_evaluate(&s->pulse, &d->estimate.model);
  if (e.size_q16 < STANDING_Q16) return find_no_emf(d);
  s->pulses++;
  if (s->pulses > 1u) return judge_pair(d, &e);
  s->first = e;
  return listen((uint16_t)flying_pause(&e, &d->estimate.model, PAUSE_MIN, PAUSE_MAX));
}

// Middle of a window of the last period, on the start's clock; ticks count on behind the end of their format.
static int32_t tick_of(const drive_t* d, const estimator_window_t* w) {
  return (int32_t)(clock_of(d) - (uint32_t)(ESTIMATOR_PERIOD_TICKS - w->middle_tick));
}

static start_phase_t step_pulse(drive_t* d) {
  flying_start_t* const s = &flying_start;
  if (d->flags.gates_off) return start_has_exclusive_slot(d) ? judge_pulse(d) : START_GOES_ON;
  for (uint16_t k = 0; k < d->samples.count; k++) {
    const estimator_window_t* const w = &d->samples.windows[k];
    // Of the period in which the gates came on, what lies behind that instant counts: at 3000 rpm it is enough.
    const bool early = d->flags.invalid > 0u && w->middle_tick - w->span_ticks / 2 < starting.on_tick + ON_TICKS;
    if (!early) flying_add(&s->pulse, &d->estimate.model, w, tick_of(d, w));
  }
  const bool enough = flying_current(&s->pulse) > d->config.values.current_limit / 16;
  if (s->pulse.windows > 0u && (enough || starting.tick >= PULSE_MAX)) start_power(d, false);
  return START_GOES_ON;
}

static void carry_on(drive_t* d, int32_t axis_bam) {
  flying_rotor_t* const rotor = &flying_start.rotor;
  rotor->angle_bam += (uint32_t)rotor->speed_bpp + (uint32_t)axis_bam;
  position_preset_axis(&d->estimate, rotor->angle_bam, rotor->speed_bpp);
}

// The first periods go to the axis and the inverse inductances, in the frame that turns with the rotor as the back-EMF
// has it. How far the axis is from there, once that is known.
static int32_t learn(drive_t* d) {
  flying_start_t* const s = &flying_start;
  int32_t axis_bam = 0;
  s->learnt = start_sees_axis(d, d->flags.invalid == 0u, &axis_bam);
  s->flux_due = s->learnt;
  return q_limit(axis_bam, STRAY_MAX_BAM);
}

static void begin_catch(drive_t* d) {
  d->flags.caught = true;
  d->flags.unseen = 0;
  start_enter(START_CATCH);
}

// The rotor's half turn is known; the estimators have to follow it with a small error before the drive may run.
static start_phase_t follow_rotor(drive_t* d) {
  flying_start_t* const s = &flying_start;
  if (d->flags.gates_off) start_power(d, true);
  // A start that asks no saliency for the axis has nothing to learn and nothing to watch: the pulses' word is the last.
  const bool at_once = start_is_open_loop(d);
  if (at_once || !s->learnt) {
    carry_on(d, at_once ? 0 : learn(d));
    const bool ready = at_once && d->flags.invalid == 0u && start_has_exclusive_slot(d);
    if (ready) start_run(d, s->rotor.angle_bam, s->rotor.speed_bpp);
    return START_GOES_ON;
  }
  if (s->flux_due) {
    if (!start_has_exclusive_slot(d)) return START_GOES_ON;
    take_flux(d);
    s->flux_due = false;
    return START_GOES_ON;
  }
  s->stray = qc_follow(s->stray, d->estimate.avv.error_bam, 4);
  if (starting.tick < CATCH_PERIODS || !start_has_exclusive_slot(d)) return START_GOES_ON;
  if (qc_abs_sat(s->stray) >= STRAY_MAX_BAM) return try_again(d);
  start_run(d, d->estimate.avv.observer.angle_bam, d->estimate.avv.observer.speed_bpp);
  return START_GOES_ON;
}

// The references are the start's until the drive runs, so it weakens the field itself.
static start_phase_t step_catch(drive_t* d) {
  const task_t task = d->schedule.task;
  if (d->flags.shorted) {
    if (task != TASK_FIELD) close_loop(d);
    return START_GOES_ON;
  }
  if (task == TASK_SPEED) drive_refer_field(d, &d->control);
  if (task == TASK_FIELD) drive_weaken_field(d, &d->control);
  return follow_rotor(d);
}

const phase_t listen_phase = {begin_listen, step_listen, NULL};
const phase_t pulse_phase = {begin_pulse, step_pulse, NULL};
const phase_t catch_phase = {begin_catch, step_catch, NULL};

#include <stddef.h>

#include "firmware/base/clear.h"
#include "firmware/commissioning/commissioning.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/commissioning/result.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "firmware/start/start.h"
#include "hal/hal_replay.h"
#include "hal/qmath/qcall.h"

#define LONGER_TICKS 500
#define SAMPLING_MIN_TICKS 450  // two bursts and the shortest useful time between them

commissioning_t commissioning;

static commissioning_report_t report;
static const state_request_t commission = {DRIVE_COMMISSION, DRIVE_READY};

void commissioning_reset(void) {
  clear(&commissioning, sizeof commissioning);
  report.count = 0;
}

static bool at_once(drive_t* d) {
  (void)d;
  return true;
}

// By commissioning_phase_t; the evaluation is the background level's.
static bool (*const phases[])(drive_t* d) = {at_once, commissioning_align, commissioning_climb, commissioning_spin,
                                             commissioning_map};

// Per mille of the time of the whole at which each begins, as motor A takes it.
static const int16_t begins[] = {0, 0, 8, 173, 242, 1000, 1000};

static void commissioning_begin(drive_t* d, drive_state_t behind) {
  (void)behind;  // it ends in READY
  commissioning_t* const c = &commissioning;
  c->outcome = COMMISSIONING_RUNNING;
  c->phase = COMMISSIONING_IDLE;
  c->tick = 0;
  c->evaluate = false;
  c->solve_motion = false;
  c->predicting = false;
  c->uniform = false;
  report.count = 0;
  start_state.begin(d, DRIVE_COMMISSION);
}

static void commissioning_abandon(void) {
  commissioning_t* const c = &commissioning;
  if (c->outcome != COMMISSIONING_RUNNING) return;
  c->outcome = COMMISSIONING_ABORTED;
  c->phase = COMMISSIONING_IDLE;
  drive_parameters_changed();
}

static void next_phase(drive_t* d) {
  commissioning_t* const c = &commissioning;
  c->phase = (commissioning_phase_t)((uint16_t)c->phase + 1u);
  c->tick = 0;
  d->flags.frozen = c->phase != COMMISSIONING_ALIGN;
  if (c->phase != COMMISSIONING_EVALUATE) {
    c->mismatch_q30 = d->estimate.trim.mismatch_q30;
    return;
  }
  drive_open_power_stage(d);
  d->flags.spins = false;
  d->flags.over = true;
  c->evaluate = true;
}

static void commissioning_step(drive_t* d) {
  commissioning_t* const c = &commissioning;
  if (c->phase == COMMISSIONING_EVALUATE) {
    if (!c->evaluate) drive_enter(d, DRIVE_READY);
    return;
  }
  const bool done = phases[c->phase](d);
  c->tick = qc_add_sat(c->tick, 1);
  if (done) next_phase(d);
}

static bool has_failed(const drive_t* d) {
  return commissioning.outcome == COMMISSIONING_RUNNING && d->state == DRIVE_FAULT;
}

static void settle(const drive_t* d) {
  commissioning_t* const c = &commissioning;
  if (has_failed(d)) {
    c->outcome = COMMISSIONING_FAILED;
    c->phase = COMMISSIONING_IDLE;
  }
  if (c->solve_motion) {
    commissioning_solve_motion(c);
    c->solve_motion = false;
  }
  if (c->map.judge) {
    c->map.lost = commissioning_judge_level(c);
    c->map.judge = false;
  }
  if (!c->evaluate) return;
  commissioning_judge(c, &report);
  c->outcome = commissioning_use(&report);
  drive_parameters_changed();
  c->evaluate = false;
}

// Also of one that was asked for and did not begin.
static void put_back(void) {
  commissioning_t* const c = &commissioning;
  if (c->sampling == SAMPLING_USUAL || drive.request.begin == &commission || c->outcome == COMMISSIONING_RUNNING)
    return;
  commissioning_sample(SAMPLING_USUAL);
}

void commissioning_service(const drive_t* d) {
  const bool wanted = has_failed(d) || commissioning.solve_motion || commissioning.map.judge || commissioning.evaluate;
  if (wanted && hal_replay_has_work(REPLAY_EVALUATED)) {
    hal_replay_work_begin(REPLAY_EVALUATED);
    settle(d);
    hal_replay_work_end();
  }
  put_back();
}

const state_t commissioning_state = {commissioning_begin, commissioning_step, commissioning_estimate,
                                     commissioning_abandon};

// The sensors' ringing after an edge is a tenth of a degree at the usual settle time; while it measures that counts.
static void settle_longer(modulator_config_t* m) {
  sampling_config_t* const c = &m->sampling;
  const int16_t most = (int16_t)(m->pulse_ticks / 20 * 13 - SAMPLING_MIN_TICKS);
  c->settle_ticks = (int16_t)q_min(c->settle_ticks + LONGER_TICKS, q_max(c->settle_ticks, most));
}

static packed_text_t make(drive_config_t* c) {
  if (commissioning.sampling == SAMPLING_USUAL) return PACKED_NONE;
  settle_longer(&c->modulator);
  if (commissioning.sampling == SAMPLING_AT_ZERO) {  // no alternating layout, no window to extend a vector for
    c->modulator.pulse_ticks = 0;
    c->modulator.extended.window_max_ticks = 0;
  }
  return PACKED_NONE;
}

const config_part_t commissioning_part = {make, NULL};

void commissioning_sample(commissioning_sampling_t how) {
  commissioning.sampling = how;
  drive_parameters_changed();
}

// It begins with the next interrupt, behind what was changed before, or not at all.
void drive_command_commission(void) {
  commissioning_sample(SAMPLING_LONGER);
  drive_exchange();
  drive.request.begin = &commission;
}

commissioning_outcome_t drive_commissioning_outcome(void) { return commissioning.outcome; }

// Heat sinks may take minutes, and one whose fan stands takes for ever: who waits is told.
static bool cools(const commissioning_t* c) {
  const bool rests =
      (c->phase == COMMISSIONING_STAIRCASE) ? c->staircase.tick == 0 : c->phase == COMMISSIONING_MAP && c->map.pause;
  return rests && interlock_is_warm();
}

commissioning_phase_t drive_commissioning_phase(void) {
  return cools(&commissioning) ? COMMISSIONING_COOLING : commissioning.phase;
}

// Share of the phase that is done, per mille.
static int32_t within_phase(const commissioning_t* c) {
  if (c->phase == COMMISSIONING_STAIRCASE) return (int32_t)c->staircase.index * 1000 / (int32_t)STAIRCASE_LEVELS;
  if (c->phase == COMMISSIONING_MAP) return commissioning_map_done(&c->map);
  if (c->phase == COMMISSIONING_SPIN) return (int32_t)c->spin.leg * 250;
  return 0;
}

int32_t drive_commissioning_progress(void) {
  const commissioning_t* const c = &commissioning;
  const int16_t* const here = &begins[c->phase];
  return here[0] + within_phase(c) * (here[1] - here[0]) / 1000;
}

uint16_t drive_commissioning_count(void) { return report.count; }

const commissioning_result_t* drive_commissioning_result(uint16_t index) {
  return (index < report.count) ? &report.list[index] : NULL;
}

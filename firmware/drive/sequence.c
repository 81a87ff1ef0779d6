// The states of the drive: boot, offset calibration, ready, start, run, stop, fault.

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "hal/hal_safety.h"
#include "hal/qmath/qcall.h"

#define CALIBRATE_PERIODS 256u
#define SAMPLES_TIMEOUT 2000u
#define OFFSET_MAX_Q8 (100L * 256L)          // codes off the middle: about 1 A on a 20 A range
#define OFFSET_END_Q8 (128L * 256L)          // none beyond is ever used: samples stay in their formats
#define OFFSET_RESIDUAL_MAX_Q8 (10L * 256L)  // mean deviation from the offset, codes: ten times the converter's noise
#define STOPPED_RPM 2                        // slower has stopped
#define SETTLE_TIMEOUT 100000u               // 10 s

// A shaft whose EMF exceeds the DC link drives a current through the diodes: no time to look for offsets. It brakes the
// shaft, and with the EMF below the link it ends.
static bool current_flows(drive_t* d) {
  const int32_t off_q8 =
      qc_abs_sat(d->samples.raw_a_q8 - d->zero_current_a_q8) + qc_abs_sat(d->samples.raw_b_q8 - d->zero_current_b_q8);
  d->offset_residual_q8 = q_follow_near(d->offset_residual_q8, off_q8, 5);
  return d->offset_residual_q8 > OFFSET_RESIDUAL_MAX_Q8;
}

static int32_t usable_offset(int32_t rest_q8) {
  return q_clamp(rest_q8, DRIVE_MIDDLE_Q8 - OFFSET_END_Q8, DRIVE_MIDDLE_Q8 + OFFSET_END_Q8);
}

static void calibrate(drive_t* d) {
  if (d->supervision.missing > SAMPLES_TIMEOUT) drive_trip(d, FAULT_NO_SAMPLES);
  if (d->samples.count == 0u) return;
  d->zero_current_a_q8 = q_follow_near(d->zero_current_a_q8, d->samples.raw_a_q8, 4);
  d->zero_current_b_q8 = q_follow_near(d->zero_current_b_q8, d->samples.raw_b_q8, 4);
  d->estimate.trim.offset_a_q8 = usable_offset(d->zero_current_a_q8);
  d->estimate.trim.offset_b_q8 = usable_offset(d->zero_current_b_q8);
  const bool flows = current_flows(d);
  if (flows) d->settled_at = d->periods + CALIBRATE_PERIODS;
  const bool settled = d->periods >= d->settled_at;
  if (d->periods < CALIBRATE_PERIODS || (!settled && d->periods < SETTLE_TIMEOUT)) return;
  const bool plausible = qc_abs_sat(d->zero_current_a_q8 - DRIVE_MIDDLE_Q8) < OFFSET_MAX_Q8 &&
                         qc_abs_sat(d->zero_current_b_q8 - DRIVE_MIDDLE_Q8) < OFFSET_MAX_Q8;
  if (plausible && settled) {
    drive_enter(d, DRIVE_READY);
  } else {
    drive_trip(d, FAULT_OFFSET);
  }
}

// A commissioning that is under way, or that a start leads to, is not wanted any more.
static void abandon(void) {
  const state_t* const s = drive_states[DRIVE_COMMISSION];
  if (s != NULL) s->abandon();
}

// Opens the power stage at once and goes back to READY.
static void coast(drive_t* d) {
  drive_open_power_stage(d);
  abandon();
  drive_enter(d, DRIVE_READY);
}

static void stop(drive_t* d) {
  drive_supervision_t* const v = &d->supervision;
  const int32_t still = config_slow_bpp(&d->config, STOPPED_RPM);
  if (d->control.ramp.value != 0) return;
  v->stopping_periods++;
  if (qc_abs_sat(d->estimate.selected.speed_bpp) <= still) {
    coast(d);
  } else if (v->stopping_periods > (uint32_t)d->config.values.stop_time * DRIVE_PERIODS_PER_MS) {
    drive_trip(d, FAULT_STOP);
  }
}

static void begin_stop(drive_t* d) {
  d->supervision.stopping_periods = 0;
  drive_enter(d, DRIVE_STOP);
}

// A start or a commissioning that is not wanted any more: stops the shaft where it turns, else opens the power stage.
static void break_off(drive_t* d) {
  // The gates are off already, and the background level is about to write what was found.
  if (d->flags.over) return;
  const bool turning = drive_is_turning(d);
  abandon();
  if (turning) {
    begin_stop(d);
  } else {
    coast(d);
  }
}

static void begin_state(drive_t* d, const state_request_t* r) {
  const state_t* const s = drive_states[r->state];
  if (s != NULL) s->begin(d, r->behind);
}

static void take_requests(drive_t* d) {
  drive_request_t* const r = &d->request;
  if (!(r->stop || r->coast || r->reset || r->begin != NULL)) return;
  if (r->coast && drive_is_energised()) coast(d);
  if (r->coast) r->begin = NULL;
  r->coast = false;
  if (r->reload) return;  // first the changed parameters, then the start
  if ((d->state == DRIVE_START || d->state == DRIVE_COMMISSION) && r->stop) break_off(d);
  if (d->state == DRIVE_READY && r->begin != NULL) begin_state(d, r->begin);
  if (d->state == DRIVE_RUN && r->stop) begin_stop(d);
  if (d->state == DRIVE_FAULT && r->reset) {
    d->fault = FAULT_NONE;
    hal_safety_fault_lamp(false);
    drive_enter(d, DRIVE_CALIBRATE);
  }
  r->stop = false;
  r->reset = false;
  r->begin = NULL;
}

// Before the state's step, which may begin with it. Command and target are written at this level alone, so that a fault
// puts both to zero, or comes before both.
static void take_speed(drive_t* d) {
  if (!d->request.speed) return;
  drive_control_t* const c = &d->control;
  d->request.speed = false;
  c->command_rpm_q16 = d->request.speed_rpm_q16;
  if (d->flags.spins) return;  // the spin has a speed of its own
  const int32_t limit_q16 = d->config.values.speed_limit * 256;
  c->target_bpp = qc_mul_sat(q_clamp(c->command_rpm_q16, -limit_q16, limit_q16), d->config.bpp_per_rpm_q8, 24);
}

// Once in a millisecond, where the speed control has nothing to do.
static void step_run(drive_t* d) {
  if (drive_states[DRIVE_RUN] != NULL) drive_states[DRIVE_RUN]->step(d);
}

void drive_sequence(drive_t* d) {
  d->periods++;
  d->heartbeat++;
  if (d->schedule.task == TASK_SPEED) d->time_ms++;
  if (d->schedule.task == TASK_FIELD && d->state == DRIVE_RUN) step_run(d);
  hal_safety_toggle_enable();
  take_speed(d);
  switch (d->state) {
    case DRIVE_BOOT:
      if (!feature_status.loading) drive_enter(d, DRIVE_CALIBRATE);
      break;
    case DRIVE_CALIBRATE:
      calibrate(d);
      break;
    case DRIVE_START:
      drive_states[DRIVE_START]->step(d);
      break;
    case DRIVE_STOP:
      stop(d);
      break;
    case DRIVE_COMMISSION:
      drive_states[DRIVE_COMMISSION]->step(d);
      break;
    default:
      break;
  }
  take_requests(d);
}

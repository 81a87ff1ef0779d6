// The states of the drive: boot, offset calibration, ready, start, run, stop, fault.

#include "firmware/drive.h"
#include "firmware/parameters.h"
#include "firmware/position.h"
#include "firmware/sampling.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_safety.h"

#define CALIBRATE_PERIODS 256u
#define SAMPLES_TIMEOUT 2000u
#define OFFSET_MAX_Q8 (100L * 256L)  // codes off the middle: about 1 A on a 20 A range
#define SETTLE_PERIODS 200u          // for the angle to be found with the power stage on
#define CLOSED_PERIODS 100u          // for the current loop to settle at zero
#define POLARITY_TRIES 3u

static void enter(drive_t* d, drive_state_t state) {
  d->state = state;
  d->periods = 0;
}

static void calibrate(drive_t* d) {
  slopes_config_t* const c = &d->config.slopes;
  if (d->periods > SAMPLES_TIMEOUT) drive_raise(d, FAULT_NO_SAMPLES);
  if (d->samples.count == 0u) return;
  c->offset_a_q8 += q_shr(d->samples.raw_a_q8 - c->offset_a_q8, 4);
  c->offset_b_q8 += q_shr(d->samples.raw_b_q8 - c->offset_b_q8, 4);
  if (d->periods < CALIBRATE_PERIODS) return;
  const bool plausible = q_abs_sat(c->offset_a_q8 - 2048L * 256L) < OFFSET_MAX_Q8 &&
                         q_abs_sat(c->offset_b_q8 - 2048L * 256L) < OFFSET_MAX_Q8;
  if (plausible) {
    enter(d, DRIVE_READY);
  } else {
    drive_raise(d, FAULT_OFFSET);
  }
}

static void begin_start(drive_t* d) {
  if (!d->config_valid || !d->control.speed_ready || hal_irq_unexpected_count() != 0u) {
    drive_raise(d, FAULT_PARAMETER);
    return;
  }
  static const drive_supervision_t healthy = {0, 0, 0};
  d->supervision = healthy;
  d->polarity_tries = 0;
  d->model = d->config.nameplate;
  admittance_init(&d->position.admittance, &d->model);
  sensor_match_reset(&d->position.sensors);
  position_preset(d, 0);
  modulator_reset(&d->modulation.state);
  field_weakening_reset(&d->control.weakening);
  d->control.ramp.value = 0;
  d->control.target_bpp = 0;
  d->control.reference_q20.d = 0;
  d->control.reference_q20.q = 0;
  d->polarity.result = POLARITY_PENDING;
  d->polarity.tick = POLARITY_LENGTH;
  enter(d, DRIVE_START);
  if (!hal_pwm_gates_on()) drive_raise(d, FAULT_OVER_CURRENT);
}

static void begin_run(drive_t* d, uint32_t angle_bam) {
  position_preset(d, angle_bam);
  position_align_encoder(d, angle_bam);
  speed_controller_preset(&d->control.speed, 0);
  d->control.reference_q20.q = 0;
  enter(d, DRIVE_RUN);
}

static void try_polarity(drive_t* d) {
  const int32_t current = q_min(parameters.polarity_current << d->polarity_tries, parameters.current_limit);
  const int32_t torque_q16 = q_mul(machine_torque_constant_q24(&d->model, 0), current, 28);
  polarity_begin(&d->polarity, d->position.avv.observer.angle_bam, current,
                 q_mul_sat(torque_q16, d->model.accel_q12, 20));
  d->polarity_tries++;
}

static void judge_polarity(drive_t* d) {
  const uint32_t angle = d->position.avv.observer.angle_bam;
  if (d->polarity.result == POLARITY_RIGHT) {
    begin_run(d, angle);
  } else if (d->polarity.result == POLARITY_WRONG) {
    begin_run(d, angle + ANGLE_BAM_HALF_TURN);
  } else if (d->polarity_tries >= POLARITY_TRIES) {
    drive_raise(d, FAULT_POLARITY);
  } else {
    try_polarity(d);
  }
}

static void start(drive_t* d) {
  d->control.closed = d->periods > SETTLE_PERIODS;
  if (d->periods < SETTLE_PERIODS + CLOSED_PERIODS) return;
  if (parameters.polarity_check == 0) {
    begin_run(d, d->position.avv.observer.angle_bam);
    return;
  }
  const uint32_t raw = d->position.avv.observer.angle_bam + (uint32_t)d->position.avv.error_bam;
  if (d->polarity.tick < POLARITY_LENGTH) d->control.reference_q20.q = polarity_step(&d->polarity, raw);
  if (d->polarity.tick < POLARITY_LENGTH) return;
  d->control.reference_q20.q = 0;
  if (d->polarity_tries == 0u) {
    try_polarity(d);
  } else {
    judge_polarity(d);
  }
}

static void stop(drive_t* d) {
  const int32_t still = q_mul(2L * 65536L, d->config.bpp_per_rpm_q8, 24);
  if (d->control.ramp.value != 0 || q_abs_sat(d->position.used.speed_bpp) > still) return;
  hal_pwm_gates_off();
  d->control.closed = false;
  enter(d, DRIVE_READY);
}

// Opens the power stage at once and goes back to READY.
static void abandon_start(drive_t* d) {
  hal_pwm_gates_off();
  d->control.closed = false;
  enter(d, DRIVE_READY);
}

static void take_requests(drive_t* d) {
  drive_request_t* const r = &d->request;
  if (r->reload) return;  // first the changed parameters, then the start
  if (d->state == DRIVE_START && r->stop) abandon_start(d);
  if (d->state == DRIVE_READY && r->start) begin_start(d);
  if (d->state == DRIVE_RUN && r->stop) enter(d, DRIVE_STOP);
  if (d->state == DRIVE_FAULT && r->reset) {
    d->fault = FAULT_NONE;
    hal_safety_fault_lamp(false);
    enter(d, DRIVE_CALIBRATE);
  }
  r->start = false;
  r->stop = false;
  r->reset = false;
}

void drive_sequence(drive_t* d) {
  d->periods++;
  d->heartbeat++;
  hal_safety_toggle_enable();
  switch (d->state) {
    case DRIVE_BOOT:
      enter(d, DRIVE_CALIBRATE);
      break;
    case DRIVE_CALIBRATE:
      calibrate(d);
      break;
    case DRIVE_START:
      start(d);
      break;
    case DRIVE_STOP:
      stop(d);
      break;
    default:
      break;
  }
  take_requests(d);
}

// The start: finds the rotor's axis with the power stage on, then the polarity of the magnet, and hands over to RUN.

#include "firmware/drive.h"
#include "firmware/parameters.h"
#include "firmware/position.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"

#define SETTLE_PERIODS 200u  // for the angle to be found with the power stage on
#define CLOSED_PERIODS 100u  // for the current loop to settle at zero
#define POLARITY_TRIES 3u

void drive_begin_start(drive_t* d) {
  if (!d->config_valid || !d->control.speed_ready || hal_irq_unexpected_count() != 0u) {
    drive_raise(d, FAULT_PARAMETER);
    return;
  }
  static const drive_supervision_t healthy = {0};
  d->supervision = healthy;
  d->polarity_tries = 0;
  d->model = d->config.nameplate;
  sensor_match_reset(&d->position.sensors);
  position_preset(d, 0);
  modulator_reset(&d->modulation.state);
  field_weakening_reset(&d->control.weakening);
  d->control.ramp.value = 0;
  d->control.reference_q20.d = 0;
  d->control.reference_q20.q = 0;
  d->polarity.result = POLARITY_PENDING;
  d->polarity.tick = POLARITY_LENGTH;
  drive_enter(d, DRIVE_START);
  if (!hal_pwm_gates_on()) drive_raise(d, FAULT_OVER_CURRENT);
}

static void begin_run(drive_t* d, uint32_t angle_bam) {
  position_preset(d, angle_bam);
  position_align_encoder(d, angle_bam);
  speed_controller_preset(&d->control.speed, 0);
  d->control.reference_q20.q = 0;
  drive_enter(d, DRIVE_RUN);
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

void drive_start(drive_t* d) {
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

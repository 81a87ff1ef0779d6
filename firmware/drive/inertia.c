// Inertia learnt from run-ups, and what hangs on it.

#include "firmware/drive/inertia.h"

#include "firmware/drive/position.h"
#include "hal/qmath/qcall.h"

#define STILL_RPM 20

inertia_match_t inertia_match;

int32_t drive_accel_q8(const drive_t* d, int32_t id_q20, int32_t iq_q20) {
  const dq_t current_q20 = {id_q20, iq_q20};
  return qc_mul_sat(machine_torque_q16(&d->estimate.model, current_q20), d->estimate.model.accel_q12, 20);
}

static void look(const drive_t* d, inertia_seen_t* in) {
  in->angle_bam = d->estimate.selected.angle_bam;
  in->speed_bpp = d->estimate.selected.speed_bpp;
  in->reference_bpp = d->control.ramp.value;
  in->torque_accel_q8 = d->estimate.torque_accel_q8;
  // Three tenths of what the current limit gives.
  in->least_accel_q8 = drive_accel_q8(d, 0, d->config.values.current_limit) / 10 * 3;
  in->still_bpp = config_slow_bpp(&d->config, STILL_RPM);
}

// The load that the observer has made of the wrong inertia goes, and the speed that it could not believe comes.
static void hand_on(const drive_t* d, drive_estimate_t* e, speed_controller_t* speed, int32_t factor_q24) {
  const inertia_match_t* const s = &inertia_match;
  machine_model_scale_inertia(&e->model, &d->config.nameplate, s->ratio_q24);
  speed_controller_scale(speed, s->ratio_q24);
  if (s->phase == INERTIA_RUN_UP) {
    e->observer.load_accel_q8 = s->start_base_q8;
    e->observer.speed_bpp = q_limit(qc_add_sat(s->speed0_bpp, s->gained_bpp), MACHINE_SPEED_END_BPP);
  } else {
    e->observer.load_accel_q8 = qc_mul_sat(e->observer.load_accel_q8, factor_q24, 24);
  }
}

// Without the map a large current turns the angle, and the torque is less than the current says: that would be taken
// for inertia.
void drive_match_inertia(const drive_t* d, drive_estimate_t* e, speed_controller_t* speed) {
  const bool alone = drive_source_has(d, SOURCE_SINGLE) && drive_source_has(d, SOURCE_READS);
  if (d->config.values.inertia_adapt == 0 || !d->config.mapped || !alone) return;
  if (d->state != DRIVE_RUN) {
    inertia_match.quiet_ms = 0;
    inertia_match.phase = INERTIA_REST;
    return;
  }
  inertia_seen_t in;
  look(d, &in);
  const int32_t factor_q24 = inertia_match_step(&inertia_match, &in, DRIVE_PERIODS_PER_MS);
  if (factor_q24 != INERTIA_SAME_Q24) hand_on(d, e, speed, factor_q24);
}

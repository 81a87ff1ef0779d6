// The control interrupt: once per PWM period, at its start. Its step reads like the block diagram.

#include <stddef.h>

#include "firmware/drive/steps.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/interfaces/phase_control.h"
#include "firmware/mode/mode.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "hal/hal_replay.h"
#include "hal/hal_sci.h"

void (*volatile drive_onlooker)(void);

static void read_samples(drive_t* d) {
  if (d->modulation.sliced == 0u) {
    drive_read_samples(d, &d->samples, &d->supervision.missing);
  } else if (!edition_phase_control->samples(d, &d->samples, &d->estimate.measured_q20, &d->supervision.missing)) {
    drive_trip(d, FAULT_CURRENT_LIMIT);
  }
}

void drive_control_step(drive_t* d) {
  schedule_next(d, &d->schedule);
  read_samples(d);
  const bool windows = d->samples.count > 0u;
  hal_profile_step(windows ? CYCLES_READ_SAMPLES : CYCLES_READ_SLICES);
  drive_estimate(d, &d->estimate);
  hal_profile_step(windows ? CYCLES_ESTIMATE : CYCLES_ESTIMATE_NO_WINDOWS);
  const drive_fault_t fault = drive_protect(d, &d->supervision, &d->estimate.observer.residual);
  if (fault != FAULT_NONE) drive_trip(d, fault);
  drive_sequence(d);
  hal_profile_step(windows ? CYCLES_SUPERVISE : CYCLES_SUPERVISE_NO_WINDOWS);
  drive_control_speed(d, &d->control, &d->estimate);
  drive_control_current(d, &d->control);
  hal_profile_step(CYCLES_CONTROL);
  drive_modulate(d, &d->modulation, &d->control.current);
  void (*const onlooker)(void) = drive_onlooker;
  if (onlooker != NULL) onlooker();
}

void drive_control_interrupt(void) {
  hal_irq_control_begin();
  hal_replay_step_begin();
  drive_control_step(&drive);
  hal_replay_step_end();
  hal_sci_service();
  hal_profile_step(CYCLES_SERIAL);
  hal_irq_control_end();
}

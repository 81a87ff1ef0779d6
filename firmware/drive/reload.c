// What the drive does between two control interrupts.

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/config/config.h"
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/service.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"

// The dead band of the gate signals, ticks; the power stage's own minimum is the parameter's business.
uint16_t drive_dead_band_ticks(void) {
  const int32_t ticks = q_shr_round(parameters.dead_time * 100, 16);
  return (uint16_t)q_max(ticks, (int32_t)HAL_PWM_DEAD_BAND_MIN_TICKS);
}

// A changed parameter becomes effective as a whole, between two control interrupts. Only this level writes the
// configuration, so it may be read here without a lock; a start that is asked for meanwhile waits for the request to be
// taken back.
static void reload(void) {
  const packed_text_t conflict = parameter_conflict();
  const bool valid = conflict == PACKED_NONE;
  const uint16_t state = hal_irq_disable();
  hal_replay_work_begin(REPLAY_RELOADED);
  drive.request.reload = false;
  drive.source = drive_source_selected();
  drive.config_valid = valid;
  drive.conflict = conflict;
  drive.conflict_known = true;
  if (valid) drive_config_take(&drive.config);
  drive.control.current_limit_q20 = interlock_current_limit();
  drive_command_speed(drive_commanded_speed());  // in the units of the new configuration
  if (!drive_is_energised()) {
    drive_machine_reset();
    if (drive.config_valid) drive.config_valid = hal_pwm_set_dead_band(drive_dead_band_ticks());
  }
  hal_replay_work_end();
  hal_irq_restore(state);
}

void drive_exchange(void) {
  if (drive.request.reload && hal_replay_has_work(REPLAY_RELOADED)) reload();
}

void background_step(drive_t* d) {
  for (uint16_t k = 0; edition_works[k] != NULL; k++) edition_works[k](d);
  drive_exchange();
}

void drive_service(void) {
  if (!feature_status.stepped) background_step(&drive);
}

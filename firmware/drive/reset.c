// The state after power-on.

#include "firmware/drive/reset.h"

#include <stddef.h>

#include "firmware/base/clear.h"
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/position.h"
#include "firmware/drive/sampling.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/service.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"

void drive_machine_reset(void) {
  drive.estimate.model = drive.config.nameplate;
  drive.control.speed_ready = speed_controller_init(&drive.control.speed, &drive.config.speed, &drive.estimate.model);
}

void drive_reset(void) {
  clear(&drive, sizeof drive);
  sampling_reset();
  hold_end();
  clear(&polarity_watch, sizeof polarity_watch);
  clear(&inertia_match, sizeof inertia_match);
  fault_history_reset();
  parameters_reset(&parameters);
  for (uint16_t k = 0; edition_resets[k] != NULL; k++) edition_resets[k]();
  drive.zero_current_a_q8 = drive.zero_current_b_q8 = DRIVE_MIDDLE_Q8;
  drive.estimate.trim.offset_a_q8 = drive.zero_current_a_q8;
  drive.estimate.trim.offset_b_q8 = drive.zero_current_b_q8;
  drive.source = drive_source_selected();
  drive.config_valid = drive_config_load(&drive.config);
  drive.control.current_limit_q20 = interlock_current_limit();
  drive_machine_reset();
  drive.control.per_torque_constant = q_invert(machine_torque_constant_q24(&drive.estimate.model, 0));
  sampling_scale_sensors(&drive, &drive.samples);
  drive_modulation_reset(&drive.modulation);
  position_preset(&drive, &drive.estimate, 0, 0);
}

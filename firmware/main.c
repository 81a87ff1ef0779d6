// The image's entry: brings the board up, then serves the watchdog and waits for interrupts.

#include <stddef.h>

#include "firmware/console/console.h"
#include "firmware/drive.h"
#include "firmware/link/link.h"
#include "firmware/parameters.h"
#include "hal/hal_adc.h"
#include "hal/hal_clock.h"
#include "hal/hal_encoder.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_safety.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"

#define SERIAL_BAUD 115200uL

// The dead band of the gate signals, ticks; the power stage's own minimum is the parameter's business.
static uint16_t dead_band_ticks(void) {
  const int32_t ticks = q_shr_round(parameters.dead_time * 100, 16);
  return (uint16_t)q_max(ticks, (int32_t)HAL_PWM_DEAD_BAND_MIN_TICKS);
}

// A changed parameter becomes effective as a whole, between two control interrupts. Only this level writes the
// configuration, so it may be read here without a lock; a start that is asked for meanwhile waits for the request to be
// taken back.
static void reload(void) {
  static drive_config_t fresh;
  fresh = drive.config;
  const bool valid = parameter_conflict() == NULL && drive_config_load(&fresh);
  const uint16_t state = hal_irq_disable();
  drive.request.reload = false;
  drive.config_valid = valid;
  if (valid) drive.config = fresh;
  drive_command_speed(drive.control.wanted_rpm_q16);  // in the units of the new configuration
  if (!drive_is_energised()) {
    drive.model = drive.config.nameplate;
    drive.control.speed_ready = speed_controller_init(&drive.control.speed, &drive.config.speed, &drive.model);
    hal_encoder_init((uint32_t)parameters.encoder_counts);
    if (drive.config_valid) drive.config_valid = hal_pwm_set_dead_band(dead_band_ticks());
  }
  hal_irq_restore(state);
}

void firmware_main(void) {
  drive_reset();
  if (!hal_clock_init()) {
    for (;;) hal_idle();  // no clock, no drive: the gates stay off
  }
  hal_time_init();
  hal_safety_init();
  drive.config_valid = hal_pwm_init(dead_band_ticks()) && drive.config_valid;
  hal_adc_init();
  hal_encoder_init((uint32_t)parameters.encoder_counts);
  (void)hal_sci_init(SERIAL_BAUD);
  hal_irq_install(drive_control_interrupt, drive_window_interrupt);
  hal_watchdog_start();
  hal_irq_enable();
  uint32_t served = hal_time_cycles();
  uint16_t seen = drive.heartbeat;
  for (;;) {
    hal_idle();
    commissioning_service(&drive);
    if (drive.request.reload) reload();
    link_service();
    console_service();
    // The watchdog is served for a control interrupt that lives, not for a background loop that does.
    if (drive.heartbeat != seen && hal_time_cycles() - served > HAL_TIME_CYCLES_PER_US * 1000uL) {
      served = hal_time_cycles();
      seen = drive.heartbeat;
      hal_watchdog_service();
    }
  }
}

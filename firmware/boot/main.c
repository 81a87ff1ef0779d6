// The image's entry: brings the board up, then serves the watchdog and waits for interrupts.

#include "firmware/boot/main.h"

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/boot/serve.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/service.h"
#include "firmware/mode/mode.h"
#include "hal/hal_adc.h"
#include "hal/hal_clock.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_safety.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"

// What has to go on for the watchdog to be serviced: the control interrupt, not the background loop.
static uint16_t heartbeat(void) { return feature_status.stepped ? feature_status.heartbeat : drive.heartbeat; }

void firmware_main(void) {
  drive_reset();
  serve(edition_power_on);
  if (!hal_clock_init()) {
    for (;;) hal_idle();  // no clock, no drive: the gates stay off
  }
  hal_time_init();
  hal_safety_init();
  drive.config_valid = hal_pwm_init(drive_dead_band_ticks()) && drive.config_valid;
  (void)hal_sci_init(HAL_SCI_USUAL_BAUD);
  hal_adc_power_up();  // which takes 5 ms
  do serve(edition_loading);
  while (!hal_adc_is_up());
  hal_adc_set_up();
  hal_irq_install(drive_control_interrupt, drive_window_interrupt);
  serve(edition_starting);
  hal_watchdog_start();
  hal_irq_enable();
  uint32_t serviced = hal_time_cycles();
  uint16_t seen = heartbeat();
  for (;;) {
    hal_idle();
    // Written out: the stack is deepest below it.
    for (service_t* const* service = edition_pass; *service != NULL; service++) (*service)();
    const uint16_t beat = heartbeat();
    const uint32_t now = hal_time_cycles();
    if (beat != seen && now - serviced > HAL_TIME_CYCLES_PER_US * 1000uL) {
      if (edition_watch != NULL) edition_watch(now - serviced);
      serviced = now;
      seen = beat;
      hal_watchdog_service();
    }
  }
}

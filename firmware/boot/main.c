// The image's entry: brings the board up, then serves the watchdog and waits for interrupts.

#include "firmware/boot/main.h"

#include <stddef.h>

#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/can/node.h"
#include "firmware/console/console.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/steps.h"
#include "firmware/hil/hil.h"
#include "firmware/link/link.h"
#include "firmware/link/requests.h"
#include "firmware/mode/mode.h"
#include "firmware/store/store.h"
#include "hal/hal_adc.h"
#include "hal/hal_clock.h"
#include "hal/hal_encoder.h"
#include "hal/hal_irq.h"
#include "hal/hal_nvm.h"
#include "hal/hal_pwm.h"
#include "hal/hal_safety.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"

#define SERIAL_BAUD 115200uL

// Requests come over the bus as they come over the serial port.
static uint16_t answer_bus(const uint16_t* request, uint16_t count, uint16_t* answer) {
  return request_answer(GUARD_BUS, request, count, answer);
}

// What was saved is in force, and so is the configuration that goes with it.
static void end_loading(void) {
  if (!drive.loading || store_is_busy() || drive.request.reload) return;
  drive.loading = false;
  if (parameters.baud_rate != (int32_t)SERIAL_BAUD) (void)hal_sci_init((uint32_t)parameters.baud_rate);
}

// The converter needs 5 ms to come up; meanwhile it shows whether there is a memory with parameters in it. The drive
// stays in BOOT until they have been read.
static void start_converter_and_store(void) {
  hal_adc_power_up();
  (void)hal_nvm_init();  // a bus that hangs is the first job's business
  drive.loading = true;
  store_begin();
  while (!hal_adc_is_up()) store_service();
  hal_adc_set_up();
  end_loading();
}

void firmware_main(void) {
  drive_reset();
  link_reset();
  hil_reset();
  if (!hal_clock_init()) {
    for (;;) hal_idle();  // no clock, no drive: the gates stay off
  }
  hal_time_init();
  hal_safety_init();
  drive.config_valid = hal_pwm_init(drive_dead_band_ticks()) && drive.config_valid;
  (void)hal_sci_init(SERIAL_BAUD);  // until the saved rate is known, and when it cannot be made
  start_converter_and_store();
  hal_encoder_init((uint32_t)parameters.encoder_counts);
  hal_irq_install(drive_control_interrupt, drive_window_interrupt);
  selftest_look();
  hal_watchdog_start();
  hal_irq_enable();
  can_node_reset(answer_bus);
  uint32_t served = hal_time_cycles();
  uint16_t seen = hil_heartbeat(drive.heartbeat);
  for (;;) {
    hal_idle();
    store_service();
    if (!hil_is_active()) {
      background_step(&drive);
      board_service();
    }
    end_loading();
    hil_service();
    link_service();
    console_service();
    can_node_service();
    // The watchdog is served for a control interrupt that lives, not for a background loop that does.
    const uint16_t heartbeat = hil_heartbeat(drive.heartbeat);
    const uint32_t now = hal_time_cycles();
    if (heartbeat != seen && now - served > HAL_TIME_CYCLES_PER_US * 1000uL) {
      selftest_count(now - served);
      served = now;
      seen = heartbeat;
      hal_watchdog_service();
    }
  }
}

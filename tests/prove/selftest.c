// The self-test with any chip and board, any contents of the flash, and any counts and cycles of the watchdog.

#include "firmware/board/selftest.h"

#include "firmware/base/clear.h"
#include "firmware/mode/mode.h"
#include "hal/hal_adc.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_flash.h"
#include "hal/hal_selftest.h"
#include "hal/hal_time.h"
#include "tests/prove/any_parameters.h"

drive_t drive;

bool drive_is_energised(void) { return any_bool(); }

bool hal_digital_io_gates_pass(void) { return any_bool(); }
bool hal_selftest_gates_are_off(void) { return any_bool(); }
bool hal_watchdog_caused_reset(void) { return any_bool(); }
uint16_t hal_selftest_watchdog_count(void) { return any_u16; }
bool hal_selftest_ram(uint16_t pair) {
  //@ assert pair < HAL_SELFTEST_PAIRS;
  return any_bool();
}

void hal_adc_measure_reference(uint16_t* ground, uint16_t* reference) {
  *ground = any_up_to(4095);
  *reference = any_up_to(4095);
}

uint16_t hal_flash_read(uint32_t address) {
  //@ assert address < HAL_FLASH_END;
  return any_u16;
}

void prove_selftest(void) {
  static uint16_t block[200];
  selftest_reset();
  any_parameters();
  selftest_look();
  while (any_bool()) {
    octet_writer_t line = octet_writer(block, 200);
    if (any_bool()) any_parameters();
    feature_status.loading = any_bool();
    selftest_count(any_u32);
    (void)selftest_service();
    selftest_line.put(&line);
  }
}

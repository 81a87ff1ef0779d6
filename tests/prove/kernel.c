// The flash kernel with any octets on the wire, at any times, and any answer of the chip and of the flash library.

#include "firmware/flash_kernel/kernel.h"

#include "hal/hal_clock.h"
#include "hal/hal_flash.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"
#include "tests/prove/any.h"

bool hal_clock_init(void) { return any_bool(); }
void hal_time_init(void) {}
uint32_t hal_time_cycles(void) { return any_u32; }
void hal_watchdog_start(void) {}

bool hal_sci_init(uint32_t baud) {
  (void)baud;
  return any_bool();
}
void hal_sci_service(void) {}
uint16_t hal_sci_room(void) { return any_up_to(HAL_SCI_TRANSMIT_RING); }
uint16_t hal_sci_read(uint16_t* octets, uint16_t room) {
  const uint16_t count = any_up_to(room);
  for (uint16_t k = 0; k < count; k++) octets[k] = any_u16;
  return count;
}
uint16_t hal_sci_write(const uint16_t* octets, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) any_u16 = octets[k];
  return any_up_to(count);
}

void hal_flash_open(void) {}
bool hal_flash_is_locked(void) { return any_bool(); }
uint16_t hal_flash_part(void) { return any_u16; }
uint16_t hal_flash_revision(void) { return any_u16; }
void hal_flash_pass(uint16_t cycles) { (void)cycles; }
uint16_t hal_flash_read(uint32_t address) {
  (void)address;
  return any_u16;
}

static hal_flash_result_t any_result(void) { return (hal_flash_result_t)any_up_to(HAL_FLASH_FAILED); }

hal_flash_result_t hal_flash_erase(uint16_t sector) {
  //@ assert 1 <= sector <= 3;
  return any_result();
}

// Nothing of sector A.
hal_flash_result_t hal_flash_program(uint32_t address, const uint16_t* words, uint16_t count) {
  //@ assert HAL_FLASH_START <= address < HAL_FLASH_UPDATE_END;
  for (uint16_t k = 0; k < count; k++) any_u16 = words[k];
  return any_result();
}

hal_flash_failure_t hal_flash_failure(void) {
  const hal_flash_failure_t failure = {any_u16, any_u32};
  return failure;
}

void prove_kernel(void) { flash_kernel_main(); }

// Erasing and programming, up to the call into TI's library (flash_library.h).

#include "hal/f2808/flash_library.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_flash.h"

#define PASSWORDS 8u
#define SYSCLKOUT_MHZ 100uL  // see hal_clock_init

// A place in the flash as the library wants it.
#define FLASH_POINTER(address) ((uint16_t*)(uintptr_t)(address))

static hal_flash_failure_t failure;

void hal_flash_open(void) {
  for (uint16_t n = 0u; n < PASSWORDS; n++) (void)target_read16(REG_PSWD(n));
  Flash_CPUScaleFactor = FLASH_LIBRARY_SCALE(SYSCLKOUT_MHZ);
  Flash_CallbackPtr = 0;
  failure.code = FLASH_LIBRARY_DONE;
  failure.address = 0uL;
}

bool hal_flash_is_locked(void) { return reg_any(REG_CSMSCR, CSMSCR_SECURE_MASK); }

uint16_t hal_flash_part(void) { return target_read16(REG_PARTID); }

uint16_t hal_flash_revision(void) { return target_read16(REG_REVID); }

hal_flash_failure_t hal_flash_failure(void) { return failure; }

void hal_flash_pass(uint16_t cycles) { target_elapse(cycles); }

static hal_flash_result_t judge(uint16_t code, const flash_library_status_t* status) {
  if (code == FLASH_LIBRARY_DONE) return HAL_FLASH_DONE;
  failure.code = code;
  failure.address = status->first_failed;
  return code == FLASH_LIBRARY_LOCKED ? HAL_FLASH_LOCKED : HAL_FLASH_FAILED;
}

hal_flash_result_t hal_flash_erase(uint16_t sector) {
  flash_library_status_t status = {0uL, 0u, 0u};
  if (sector == 0u || sector >= HAL_FLASH_SECTORS) return HAL_FLASH_OUTSIDE;
  if (hal_flash_is_locked()) return HAL_FLASH_LOCKED;
  target_disable_interrupts();
  return judge(Flash2808_Erase(FLASH_LIBRARY_SECTOR(sector), &status), &status);
}

hal_flash_result_t hal_flash_program(uint32_t address, const uint16_t* words, uint16_t count) {
  flash_library_status_t status = {0uL, 0u, 0u};
  if (address < HAL_FLASH_START || address >= HAL_FLASH_UPDATE_END || count > HAL_FLASH_UPDATE_END - address) {
    return HAL_FLASH_OUTSIDE;
  }
  if (hal_flash_is_locked()) return HAL_FLASH_LOCKED;
  target_disable_interrupts();
  // The library does not say const; it reads only.
  return judge(Flash2808_Program(FLASH_POINTER(address), (uint16_t*)words, count, &status), &status);
}

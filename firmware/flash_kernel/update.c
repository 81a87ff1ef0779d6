#include "firmware/flash_kernel/update.h"

#include "firmware/base/crc.h"
#include "firmware/flash_kernel/kernel.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"

#define VERIFY_CODE 40u  // the flash library's own for a word that reads back otherwise

static uint32_t failed_at;
static uint16_t failed_code;

uint32_t update_failed_at(void) { return failed_at; }
uint16_t update_failed_code(void) { return failed_code; }

static uint16_t mark(void) { return hal_flash_read(HAL_FLASH_IMAGE_IDENTITY); }

static uint16_t fail(uint16_t code, uint32_t address) {
  failed_code = code;
  failed_at = address;
  return KERNEL_FLASH;
}

static uint16_t status_of(hal_flash_result_t result) {
  const hal_flash_failure_t failure = hal_flash_failure();
  switch (result) {
    case HAL_FLASH_DONE:
      return KERNEL_OK;
    case HAL_FLASH_OUTSIDE:
      return KERNEL_RANGE;
    case HAL_FLASH_LOCKED:
      return KERNEL_LOCKED;
    default:
      return fail(failure.code, failure.address);
  }
}

// One word that has to be there afterwards.
static uint16_t put(uint32_t address, uint16_t word) {
  const uint16_t status = status_of(hal_flash_program(address, &word, 1u));
  if (status != KERNEL_OK) return status;
  return hal_flash_read(address) == word ? (uint16_t)KERNEL_OK : fail(VERIFY_CODE, address);
}

uint16_t update_erase(uint16_t sector) {
  if (sector == 0u || sector >= HAL_FLASH_SECTORS) return KERNEL_RANGE;
  if (hal_flash_is_locked()) return KERNEL_LOCKED;
  // From here on the boot code does not start what is left of the image.
  if (mark() != HAL_FLASH_ERASED && mark() != 0u) {
    const uint16_t status = put(HAL_FLASH_IMAGE_IDENTITY, 0u);
    if (status != KERNEL_OK) return status;
  }
  const uint16_t status = status_of(hal_flash_erase(sector));
  if (status != KERNEL_OK) return status;
  const uint32_t start = (uint32_t)(HAL_FLASH_END - (sector + 1uL) * HAL_FLASH_SECTOR_WORDS);
  for (uint32_t k = 0uL; k < HAL_FLASH_SECTOR_WORDS; k++) {
    if (hal_flash_read(start + k) != HAL_FLASH_ERASED) return fail(VERIFY_CODE, start + k);
  }
  return KERNEL_OK;
}

static bool inside(uint32_t address, uint32_t count, uint32_t start, uint32_t end) {
  return address >= start && address < end && count <= end - address;
}

static bool differs(uint32_t address, const uint16_t* words, uint16_t count, uint32_t* where) {
  for (uint16_t k = 0u; k < count; k++) {
    *where = address + k;
    if (hal_flash_read(*where) != words[k]) return true;
  }
  return false;
}

uint16_t update_write(uint32_t address, const uint16_t* words, uint16_t count) {
  uint32_t where = 0uL;
  if (!inside(address, count, HAL_FLASH_START, HAL_FLASH_UPDATE_END)) return KERNEL_RANGE;
  if (hal_flash_is_locked()) return KERNEL_LOCKED;
  if (mark() == HAL_IMAGE_MARK) return KERNEL_STATE;
  if (address <= HAL_FLASH_IMAGE_IDENTITY && HAL_FLASH_IMAGE_IDENTITY - address < count &&
      words[HAL_FLASH_IMAGE_IDENTITY - address] != HAL_FLASH_ERASED) {
    return KERNEL_RANGE;  // the mark is update_seal's
  }
  if (!differs(address, words, count, &where)) return KERNEL_OK;  // a request that came twice
  const uint16_t status = status_of(hal_flash_program(address, words, count));
  if (status != KERNEL_OK) return status;
  return differs(address, words, count, &where) ? fail(VERIFY_CODE, where) : (uint16_t)KERNEL_OK;
}

static uint32_t add_word(uint32_t crc, uint16_t word) { return crc32_add(crc32_add(crc, word & 0xFFu), word >> 8); }

bool update_crc(uint32_t address, uint32_t count, uint32_t* crc) {
  if (!inside(address, count, HAL_FLASH_START, HAL_FLASH_END) &&
      !inside(address, count, HAL_FLASH_KERNEL_RAM, HAL_FLASH_KERNEL_RAM_END)) {
    return false;
  }
  uint32_t sum = CRC32_BEGIN;
  for (uint32_t k = 0uL; k < count; k++) sum = add_word(sum, hal_flash_read(address + k));
  *crc = crc32_end(sum);
  return true;
}

// Over all that an update writes, as it will be with its mark.
static uint32_t crc_of_image(void) {
  uint32_t sum = CRC32_BEGIN;
  for (uint32_t at = HAL_FLASH_START; at < HAL_FLASH_UPDATE_END; at++) {
    sum = add_word(sum, at == HAL_FLASH_IMAGE_IDENTITY ? HAL_IMAGE_MARK : hal_flash_read(at));
  }
  return crc32_end(sum);
}

uint16_t update_seal(uint32_t crc) {
  if (hal_flash_is_locked()) return KERNEL_LOCKED;
  if (crc_of_image() != crc) return KERNEL_STATE;
  if (mark() == HAL_IMAGE_MARK) return KERNEL_OK;
  return put(HAL_FLASH_IMAGE_IDENTITY, HAL_IMAGE_MARK);
}

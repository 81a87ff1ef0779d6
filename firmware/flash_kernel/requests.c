#include "firmware/base/octets.h"
#include "firmware/flash_kernel/kernel.h"
#include "firmware/flash_kernel/update.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"

#define STATUS_AT 2u  // behind type and tag
#define ENTRY_WORDS 2u

static void put_flash(octet_writer_t* w, uint32_t address, uint16_t count) {
  for (uint16_t k = 0u; k < count; k++) put_u16(w, hal_flash_read(address + k));
}

static uint16_t info(octet_writer_t* w) {
  put_u16(w, KERNEL_PROTOCOL);
  put_u16(w, hal_flash_part());
  put_u16(w, hal_flash_revision());
  put_u8(w, hal_flash_is_locked() ? 1u : 0u);
  put_flash(w, HAL_FLASH_IMAGE_IDENTITY, HAL_IMAGE_WORDS);
  put_flash(w, HAL_FLASH_BOOT_ENTRY, ENTRY_WORDS);
  return KERNEL_OK;
}

static uint16_t erase(octet_reader_t* r) {
  const uint16_t sector = take_u8(r);
  return octets_fit(r) ? update_erase(sector) : (uint16_t)KERNEL_LENGTH;
}

static uint16_t write(octet_reader_t* r) {
  static uint16_t words[KERNEL_WORDS_MAX];
  const uint32_t address = take_u32(r);
  const uint16_t count = octets_left(r) / 2u;
  if (count == 0u || count > KERNEL_WORDS_MAX) return KERNEL_LENGTH;
  for (uint16_t k = 0u; k < count; k++) words[k] = take_u16(r);
  return octets_fit(r) ? update_write(address, words, count) : (uint16_t)KERNEL_LENGTH;
}

static uint16_t check(octet_reader_t* r, octet_writer_t* w) {
  uint32_t crc = 0uL;
  const uint32_t address = take_u32(r);
  const uint32_t count = take_u32(r);
  if (!octets_fit(r)) return KERNEL_LENGTH;
  if (!update_crc(address, count, &crc)) return KERNEL_RANGE;
  put_u32(w, crc);
  return KERNEL_OK;
}

static uint16_t seal(octet_reader_t* r) {
  const uint32_t crc = take_u32(r);
  return octets_fit(r) ? update_seal(crc) : (uint16_t)KERNEL_LENGTH;
}

static uint16_t carry_out(uint16_t type, octet_reader_t* r, octet_writer_t* w) {
  switch (type) {
    case KERNEL_INFO:
      return octets_fit(r) ? info(w) : (uint16_t)KERNEL_LENGTH;
    case KERNEL_ERASE:
      return erase(r);
    case KERNEL_WRITE:
      return write(r);
    case KERNEL_CHECK:
      return check(r, w);
    case KERNEL_SEAL:
      return seal(r);
    case KERNEL_RESTART:
      return octets_fit(r) ? (uint16_t)KERNEL_OK : (uint16_t)KERNEL_LENGTH;
    default:
      return KERNEL_UNKNOWN;
  }
}

uint16_t kernel_answer(const uint16_t* request, uint16_t count, uint16_t* answer) {
  octet_writer_t w = octet_writer(answer, RECORD_MAX - 2u);
  octet_reader_t r = octet_reader(request, count);
  const uint16_t type = take_u8(&r);
  put_u8(&w, type | RECORD_ANSWER);
  put_u8(&w, take_u8(&r));
  put_u8(&w, KERNEL_OK);
  const uint16_t status = carry_out(type, &r, &w);
  answer[STATUS_AT] = status;
  if (status == KERNEL_FLASH) {
    put_u16(&w, update_failed_code());
    put_u32(&w, update_failed_at());
  }
  return w.count;
}

#include "firmware/board/flash_sum.h"

#include <stdbool.h>

#include "firmware/base/crc.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"

#define WORDS_A_PASS 32u
#define SUM_AT (HAL_FLASH_IMAGE_IDENTITY + HAL_IMAGE_SUM)

static uint32_t read_pair(uint32_t address) {
  return hal_flash_read(address) | ((uint32_t)hal_flash_read(address + 1uL) << 16);
}

void flash_sum_begin(flash_sum_t* sum) {
  sum->state = FLASH_SUM_NONE;
  if (hal_flash_read(HAL_FLASH_IMAGE_IDENTITY) != HAL_IMAGE_MARK) return;
  const uint32_t end = read_pair(HAL_FLASH_IMAGE_IDENTITY + HAL_IMAGE_SUM_END);
  if (end <= SUM_AT + 1uL || end > HAL_FLASH_CSM_RESERVED) return;
  sum->end = end;
  sum->expected = read_pair(SUM_AT);
  sum->next = HAL_FLASH_START;
  sum->crc = CRC32_BEGIN;
  sum->state = FLASH_SUM_UNDER_WAY;
}

void flash_sum_service(flash_sum_t* sum) {
  if (sum->state != FLASH_SUM_UNDER_WAY) return;
  for (uint16_t n = 0u; n < WORDS_A_PASS && sum->next < sum->end; n++) {
    const bool itself = sum->next == SUM_AT || sum->next == SUM_AT + 1uL;
    const uint16_t word = itself ? (uint16_t)HAL_FLASH_ERASED : hal_flash_read(sum->next);
    sum->crc = crc32_add(crc32_add(sum->crc, word), (uint16_t)(word >> 8));
    sum->next++;
  }
  if (sum->next < sum->end) return;
  sum->state = crc32_end(sum->crc) == sum->expected ? FLASH_SUM_RIGHT : FLASH_SUM_WRONG;
}

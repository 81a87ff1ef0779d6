// Whether the flash holds what was built: the CRC-32 over the image, as it lies there, against the one that the image
// carries (hal_image.h). An image that was not given one, and a program that does not run from the flash, has none.

#ifndef STILLSPIN_FIRMWARE_BOARD_FLASH_SUM_H
#define STILLSPIN_FIRMWARE_BOARD_FLASH_SUM_H

#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum { FLASH_SUM_NONE, FLASH_SUM_UNDER_WAY, FLASH_SUM_RIGHT, FLASH_SUM_WRONG } flash_sum_state_t;

typedef struct {
  flash_sum_state_t state;
  uint32_t next, end;  // addresses: the next word, and the one behind the last
  uint32_t expected;
  uint32_t crc;  // so far
} flash_sum_t;

/// Looks whether there is a sum.
void flash_sum_begin(flash_sum_t* sum);

/// The next 32 words, some 2000 cycles; nothing once the sum is known.
void flash_sum_service(flash_sum_t* sum);

#if defined(__cplusplus)
}
#endif

#endif

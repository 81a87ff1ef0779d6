// What the kernel does to the flash, and the order it keeps.

#ifndef STILLSPIN_FIRMWARE_FLASH_KERNEL_UPDATE_H
#define STILLSPIN_FIRMWARE_FLASH_KERNEL_UPDATE_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

/// Statuses of kernel.h. Where it is KERNEL_FLASH, update_failed_at and _code tell.
uint16_t update_erase(uint16_t sector);
uint16_t update_write(uint32_t address, const uint16_t* words, uint16_t count);
uint16_t update_seal(uint32_t crc);
/// CRC-32 over `count` words of the flash or of the kernel's RAM, low octet first; false when they are not all in it.
bool update_crc(uint32_t address, uint32_t count, uint32_t* crc);

uint32_t update_failed_at(void);
uint16_t update_failed_code(void);

#if defined(__cplusplus)
}
#endif

#endif

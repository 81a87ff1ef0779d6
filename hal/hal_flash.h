// The chip's flash as an update needs it: sectors B, C and D can be erased and programmed, sector A (boot entry, boot
// code, passwords) cannot. For programs that run from RAM alone: firmware/flash_kernel. Reading is for all.
//
// Programming turns ones into zeros, erasing a sector turns all of it into ones. A supply that fails during an erase
// may damage the sector for good (hal/f2808/flash_library.h).

#ifndef STILLSPIN_HAL_HAL_FLASH_H
#define STILLSPIN_HAL_HAL_FLASH_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_FLASH_START 0x3E8000uL
#define HAL_FLASH_SECTOR_WORDS 0x4000uL
#define HAL_FLASH_SECTORS 4u             // 0 is A, the uppermost; 3 is D, the lowest
#define HAL_FLASH_UPDATE_END 0x3F4000uL  // sector A begins
#define HAL_FLASH_END 0x3F8000uL
#define HAL_FLASH_CSM_RESERVED 0x3F7F80uL    // nothing is linked from here on but the entry
#define HAL_FLASH_IMAGE_IDENTITY 0x3E8020uL  // hal_image_identity_t of the drive
#define HAL_FLASH_KERNEL_RAM 0x3FA000uL
#define HAL_FLASH_KERNEL_MARK 0x464Bu  // the first word there: a host knows the kernel's file by it
#define HAL_FLASH_KERNEL_RAM_END 0x3FC000uL
#define HAL_FLASH_BOOT_ENTRY 0x3F7FF6uL
#define HAL_FLASH_ERASED 0xFFFFu

typedef enum {
  HAL_FLASH_DONE,
  HAL_FLASH_OUTSIDE,  // sector A, or no flash: nothing was touched
  HAL_FLASH_LOCKED,   // the board has passwords: nothing was touched
  HAL_FLASH_FAILED    // hal_flash_failure tells
} hal_flash_result_t;

typedef struct {
  uint16_t code;     // what the flash library gave
  uint32_t address;  // the first word that is not what it should be
} hal_flash_failure_t;

// Opens a chip whose passwords are all ones. Needs hal_clock_init.
void hal_flash_open(void);
bool hal_flash_is_locked(void);

// Part number and silicon revision as the chip tells them; an F2808 is HAL_FLASH_PART.
#define HAL_FLASH_PART 0x003Cu
uint16_t hal_flash_part(void);
uint16_t hal_flash_revision(void);

// A word of the flash, 0 while the chip is locked; or of the RAM that the kernel is loaded to, H0 by its high address.
uint16_t hal_flash_read(uint32_t address);

// Takes seconds. Interrupts are off, the watchdog is stopped.
hal_flash_result_t hal_flash_erase(uint16_t sector);

// `count` words from 1 on. A word that would need a zero turned into a one fails.
hal_flash_result_t hal_flash_program(uint32_t address, const uint16_t* words, uint16_t count);

// Of the last call that failed.
hal_flash_failure_t hal_flash_failure(void);

// The code since the last access takes this many cycles of the CPU: for a loop that waits.
void hal_flash_pass(uint16_t cycles);

#ifdef __cplusplus
}
#endif

#endif

// By what a host knows the flash kernel's file.

#include "hal/f2808/target.h"
#include "hal/hal_flash.h"

extern const uint16_t flash_kernel_identity[2];
TARGET_IDENTITY const uint16_t flash_kernel_identity[2] = {HAL_FLASH_KERNEL_MARK, 0u};

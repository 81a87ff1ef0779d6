// Apart from what needs TI's library: the drive reads its own flash and links without it.

#include "hal/f2808/reg_access.h"
#include "hal/hal_flash.h"

uint16_t hal_flash_read(uint32_t address) { return target_read16(address); }

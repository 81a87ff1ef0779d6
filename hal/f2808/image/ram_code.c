// Symbols of the linker command files: their addresses are what counts, and of the size the address is the number.

#include "hal/f2808/target.h"
#include "hal/hal_image.h"

extern const uint16_t image_ram_code_load[];
extern uint16_t image_ram_code_run[];
extern const uint16_t image_ram_code_size[];

void hal_image_copy_ram_code(void) {
  const uint32_t words = TARGET_LINKER_NUMBER(image_ram_code_size);
  for (uint32_t k = 0uL; k < words; k++) image_ram_code_run[k] = image_ram_code_load[k];
}

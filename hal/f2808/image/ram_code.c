// Symbols of the linker command files: their addresses are what counts, and of the size the address is the number.

#include "hal/f2808/target.h"
#include "hal/hal_image.h"

extern const uint16_t image_ram_code_load[], image_ram_fixed_load[], image_ram_fixed_h0_load[];
extern uint16_t image_ram_code_run[], image_ram_fixed_run[], image_ram_fixed_h0_run[];
extern const uint16_t image_ram_code_size[], image_ram_fixed_size[], image_ram_fixed_h0_size[];

static void copy(uint16_t* to, const uint16_t* from, uint32_t words) {
  for (uint32_t k = 0uL; k < words; k++) to[k] = from[k];
}

void hal_image_copy_ram_code(void) {
  copy(image_ram_code_run, image_ram_code_load, TARGET_LINKER_NUMBER(image_ram_code_size));
  copy(image_ram_fixed_run, image_ram_fixed_load, TARGET_LINKER_NUMBER(image_ram_fixed_size));
  copy(image_ram_fixed_h0_run, image_ram_fixed_h0_load, TARGET_LINKER_NUMBER(image_ram_fixed_h0_size));
}

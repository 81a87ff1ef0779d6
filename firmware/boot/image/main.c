// The image's main, called by the C run-time: the stack is set, globals are zero or initialised, the watchdog is off,
// the clock is the crystal's. firmware_main does the rest and never returns.

#include "firmware/boot/main.h"

#include "firmware/mode/commands.h"
#include "hal/hal_image.h"

int main(void) {
  hal_image_copy_ram_code();
  firmware_main();
  return 0;
}

// Vectors of the Cortex-M3; newlib's own start-up does the rest. QEMU loads the variables with the image.

#include <stdint.h>

extern uint32_t __stack;
extern void _start(void);

static void hang(void) {
  for (;;) {
  }
}

void reset(void) { _start(); }

__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    (void (*)(void))&__stack, reset, hang, hang, hang, hang, hang};

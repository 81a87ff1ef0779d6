// The kernel's main, called by the C run-time, which the boot ROM has jumped to: the stack is set, what has a value has
// it, nothing is zeroed, the watchdog runs.

#include "firmware/flash_kernel/kernel.h"

int main(void) {
  flash_kernel_main();
  return 0;
}

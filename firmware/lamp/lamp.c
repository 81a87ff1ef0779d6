#include "firmware/lamp/lamp.h"

#include "hal/hal_clock.h"
#include "hal/hal_safety.h"
#include "hal/hal_time.h"

#define HALF_A_SECOND (HAL_TIME_CYCLES_PER_S / 2uL)

void lamp_main(void) {
  (void)hal_clock_init();  // what it says shows
  hal_time_init();
  hal_safety_init();
  uint32_t since = 0;
  bool lit = false;
  for (;;) {
    if (hal_time_cycles() - since >= HALF_A_SECOND) {
      since += HALF_A_SECOND;
      lit = !lit;
      hal_safety_fault_lamp(lit);
    }
  }
}

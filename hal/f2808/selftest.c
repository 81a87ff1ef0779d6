#include "hal/f2808/gpio.h"
#include "hal/f2808/pie.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_selftest.h"

#define RAM_FIRST 0x8000uL
#define FIRST_PASSWORD 0x3F7FF8uL
#define PASSWORDS 8uL
#define CHECKERBOARD 0x5555u

// Reads what the element before has left in two words, and leaves the inverse.
static bool march(uint32_t first, uint32_t second, uint16_t left) {
  bool kept = target_read16(first) == left;
  target_write16(first, (uint16_t)~left);
  kept = target_read16(second) == left && kept;
  target_write16(second, (uint16_t)~left);
  return kept;
}

static bool march_pair(uint32_t a, uint32_t b, uint16_t ground) {
  bool kept = true;
  target_write16(a, ground);
  target_write16(b, ground);
  for (uint16_t element = 0u; element < 4u; element++) {
    const bool up = element < 2u;
    const uint16_t left = (element & 1u) == 0u ? ground : (uint16_t)~ground;
    kept = march(up ? a : b, up ? b : a, left) && kept;
  }
  return target_read16(a) == ground && target_read16(b) == ground && kept;
}

// L0 and L1 belong to the code security module, which opens when erased passwords are read. The boot ROM does that; a
// start without it has not.
static void open_memory(void) {
  for (uint32_t n = 0uL; n < PASSWORDS; n++) {
    (void)target_read16(FIRST_PASSWORD + n);
  }
}

bool hal_selftest_ram(uint16_t pair) {
  const uint32_t a = (uint32_t)(RAM_FIRST + 2uL * pair), b = (uint32_t)(a + 1uL);
  if (pair == 0u) {
    open_memory();
  }
  const uint16_t state = irq_hold();
  const uint16_t was_a = target_read16(a), was_b = target_read16(b);
  const bool kept = march_pair(a, b, CHECKERBOARD);
  target_write16(a, was_a);
  target_write16(b, was_b);
  irq_release(state);
  return kept;
}

uint16_t hal_selftest_watchdog_count(void) { return (uint16_t)(target_read16(REG_WDCNTR) & WDCNTR_WDCNTR_MASK); }

bool hal_selftest_gates_are_off(void) {
  bool off = true;
  for (uint16_t i = 0u; i < BOARD_GATE_PINS; i++) {
    off = off && gpio_read((uint16_t)(BOARD_PIN_FIRST_GATE + i)) == (BOARD_GATE_ON_LEVEL == 0u);
  }
  return off;
}

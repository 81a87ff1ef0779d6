// What a drive can ask of its own chip and board at power-up. Background level.

#ifndef STILLSPIN_HAL_HAL_SELFTEST_H
#define STILLSPIN_HAL_HAL_SELFTEST_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_SELFTEST_PAIRS 8192u              // pairs of words: L0, L1 and H0; M0 and M1, code and stack, are not
#define HAL_SELFTEST_WATCHDOG_CYCLES 10240uL  // CPU cycles for a count of the watchdog, when both clocks are right

// March C- (A. J. van de Goor, "Testing Semiconductor Memories", 1991) over two neighbouring words on a checkerboard,
// while interrupts are held off for some 150 cycles; what they held is put back. True when they keep what is written.
// It finds bits that are stuck, do not change or follow a neighbour's, not faults between distant words.
bool hal_selftest_ram(uint16_t pair);

// What the watchdog has counted since it was last serviced. It counts the crystal, the CPU's cycles come from the PLL.
uint16_t hal_selftest_watchdog_count(void);

// Whether all six gate pins have the level that switches a device off, read at the pins.
bool hal_selftest_gates_are_off(void);

#ifdef __cplusplus
}
#endif

#endif

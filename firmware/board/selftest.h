// The self-test at power-up, in the background: it costs the start no time, and what it finds opens the gates.
//
//   RAM         every pair of words once, 16 in a pass of the background loop, with the gates off only
//   clock       the watchdog's counts of the crystal against the CPU's cycles, over 100 of its services
//   converter   ground and reference at its inputs, once before the interrupts come (reference_input)
//   gate pins   all at their off level, read at the pins, before the gates are ever switched on
//   gate enable does not pass the gates before it is toggled (gate_feedback)
//   flash       CRC-32 of the image against its own (hal_image.h), 32 words in a pass; an image without is not tested

#ifndef STILLSPIN_FIRMWARE_BOARD_SELFTEST_H
#define STILLSPIN_FIRMWARE_BOARD_SELFTEST_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/api/status.h"
#include "firmware/board/flash_sum.h"
#include "firmware/mode/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Bits of selftest_t.failed; their places are codes of CATALOGUE_SELFTEST.
typedef enum {
  SELFTEST_RAM = 1,
  SELFTEST_CLOCK = 2,
  SELFTEST_CONVERTER = 4,
  SELFTEST_GATE_PINS = 8,
  SELFTEST_GATE_ENABLE = 16,
  SELFTEST_FLASH = 32
} selftest_failure_t;

typedef struct {
  uint16_t failed;
  uint16_t pair;               // of RAM, next to be tested
  uint16_t services;           // of the watchdog
  uint16_t counts;             // of the watchdog in them
  uint32_t cycles;             // of the CPU in them
  uint16_t ground, reference;  // codes
  bool passed_early;           // the gate enable passed the gates before it was toggled
  flash_sum_t flash;
} selftest_t;

extern selftest_t selftest;

void selftest_reset(void);

/// What has failed, against a start (mode/interlock.h).
drive_fault_t selftest_refusal(void);

/// Before the interrupts come, with the gates off and the converter up.
void selftest_look(void);

/// Before the watchdog is serviced, so many cycles after the last time.
void selftest_count(uint32_t cycles);

/// A pass of the background loop. FAULT_SELF_TEST when something has failed.
drive_fault_t selftest_service(void);

extern const status_line_t selftest_line;

#if defined(__cplusplus)
}
#endif

#endif

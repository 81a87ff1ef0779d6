// Host in the loop: the control interrupt is stepped by a computer that runs the plant.
//
// A board on a desk has neither motor nor power stage, and conversion results cannot be put into a real converter. So
// from here on the HAL's functions play what a step's record brings (hal/hal_tape.h) and what they are told goes back
// in its answer, with a check sum over every signal of the drive. The computer executes the same C files on the virtual
// chip and compares: a board that computes otherwise is found in the first period in which it does.
//
// Entered only with the power stage off, left only by a reset: while it lasts the gates cannot be switched on. The
// board's own period interrupt goes on, for the serial port and the watchdog alone.
//
//   step:   sequence u16, words of a result u8 (3 slices, 6 windows), windows u8, windows x (call u16, results u16
//   ...),
//           inputs u8, inputs x u16
//   answer: sequence u16, torn u8, outputs u8, outputs x u16, CRC-32 of the signals u32
//
// A step that is repeated (its answer was lost) is answered again and not carried out again.

#ifndef STILLSPIN_FIRMWARE_HIL_HIL_H
#define STILLSPIN_FIRMWARE_HIL_HIL_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/link/octets.h"

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum { HIL_OK = 0, HIL_ENERGISED, HIL_BUSY, HIL_NOT_ACTIVE, HIL_SEQUENCE, HIL_FORMAT } hil_result_t;

/// Power-on state.
void hil_reset(void);

/// The drive begins anew, as after power-on with default parameters; the next step is number 0.
hil_result_t hil_enter(void);

/// The background level stops, so the watchdog resets the board within 26 ms.
hil_result_t hil_leave(void);

/// One period.
hil_result_t hil_step(octet_reader_t* step, octet_writer_t* answer);

/// Number of the step that is expected next.
uint16_t hil_expected(void);

bool hil_is_active(void);

/// What has to go on for the watchdog to be served: the drive's own count, or while active the board's interrupt's.
uint16_t hil_heartbeat(uint16_t of_drive);

/// CRC-32 over all signals of the drive in their order, little-endian.
uint32_t hil_signals_crc(void);

#if defined(__cplusplus)
}
#endif

#endif

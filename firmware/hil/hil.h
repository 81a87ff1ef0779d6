// Host in the loop: the control interrupt is stepped by a computer that runs the plant.
//
// A board on a desk has neither motor nor power stage, and conversion results cannot be put into a real converter. So
// from here on the HAL's functions play what a step's record brings (hal/hal_replay.h) and what they are told goes back
// in its answer, with a check sum over every signal of the drive. The computer executes the same C files on the virtual
// chip and compares: a board that computes otherwise is found in the first period in which it does.
//
// Entered only with the power stage off, left only by a reset: while it lasts the gates cannot be switched on. The
// board's own period interrupt goes on, for the serial port and the watchdog alone.
//
//   step:   sequence u16, shape (windows, words of a result: 3 slices, 6 windows; inputs; works), works, inputs, and
//   each
//           window: its call and its results
//   answer: sequence u16, shape (torn, outputs), outputs, CRC-32 of the signals u32
//
// Each of these lists is words against those that last stood in the same place, of a step or of an answer
// (firmware/hil/delta.h); zeros when the loop is entered.
//
// A step that is repeated (its answer was lost) is answered again and not carried out again. When none comes for
// HIL_REST_S the board resets itself: the computer is gone, and a drive in the loop answers to nobody else.

#ifndef STILLSPIN_FIRMWARE_HIL_HIL_H
#define STILLSPIN_FIRMWARE_HIL_HIL_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"
#include "hal/hal_replay.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define HIL_REST_S 10u

#define HIL_STEP_SHAPE 4u
#define HIL_WINDOW_WORDS (1u + REPLAY_RESULTS)
#define HIL_ANSWER_SHAPE 2u

/// Words of answers, as they last stood in their places.
typedef struct {
  uint16_t shape[HIL_ANSWER_SHAPE];
  uint16_t outputs[REPLAY_OUTPUTS];
} hil_answer_t;

typedef enum { HIL_OK = 0, HIL_ENERGISED, HIL_BUSY, HIL_NOT_ACTIVE, HIL_SEQUENCE, HIL_FORMAT } hil_result_t;

/// Power-on state.
void hil_reset(void);

/// The drive begins anew, as after power-on with default parameters; the next step is number 0.
hil_result_t hil_enter(void);

/// The background level stops, so the watchdog resets the board within 26 ms.
hil_result_t hil_leave(void);

/// One period.
hil_result_t hil_step(octet_reader_t* step, octet_writer_t* answer);

/// Writes the answer to a step of which `period` has the outputs. For the computer, too, which must expect the same.
void hil_put_answer(octet_writer_t* w, uint16_t sequence, bool torn, const replay_period_t* period,
                    const hil_answer_t* before);

/// That answer becomes the one before the next.
void hil_keep_answer(hil_answer_t* before, bool torn, const replay_period_t* period);

/// Background level, while active: notices that no step comes any more.
void hil_service(void);

/// Number of the step that is expected next.
uint16_t hil_expected(void);

/// CRC-32 over all signals of the drive in their order, little-endian.
uint32_t hil_signals_crc(void);

#if defined(__cplusplus)
}
#endif

#endif

// What the hardware tells the drive, on a tape: recorded here, played elsewhere.
//
// A period of the drive is a function of its state and of what the HAL returned in it. While a tape records, the HAL's
// functions work as ever and what they return and are told is noted. While it plays, they reach no register but for
// switching gates off and the lamp: they return what is on the tape, and what they are told is noted again, to be
// compared. So the interrupts of a drive can be stepped on a board whose power stage and sensors are elsewhere, in a
// simulation, and be compared word by word with another execution of the same C files. The gates cannot be switched on
// while a tape plays.
//
// Interrupts that came while the control step ran are put back into the same call of the HAL, so that they stand
// between the same two pieces of the drive's own code. What comes behind the control step is played behind it.
//
// The background level gets to its work when interrupts and other services let it: behind the step that asked for it or
// behind a later one, or even before a step whose interrupt is late. So each piece of it that the control step depends
// on has a word on the tape, and is done on the same side of the same step, between the same windows, when it is
// played.

#ifndef STILLSPIN_HAL_HAL_TAPE_H
#define STILLSPIN_HAL_HAL_TAPE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TAPE_INPUTS 24u      // words that the HAL returns in a period
#define TAPE_OUTPUTS 48u     // words that it is told
#define TAPE_WINDOWS 20u     // window or slice interrupts in a period
#define TAPE_RESULTS 6u      // words of one of them
#define TAPE_WORKS 4u        // pieces of the background's work in a period
#define TAPE_BEHIND 0xFFFFu  // `call` of a window that came behind the control step

typedef enum { TAPE_OFF = 0, TAPE_RECORDS = 1, TAPE_PLAYS = 2 } tape_mode_t;

typedef struct {
  uint16_t call;  // hooked calls of the period's control step that had begun
  uint16_t results[TAPE_RESULTS];
} tape_window_t;

/// One period.
typedef struct {
  uint16_t input_count, output_count, window_count, work_count;
  uint16_t inputs[TAPE_INPUTS];
  uint16_t outputs[TAPE_OUTPUTS];
  tape_window_t windows[TAPE_WINDOWS];
  uint16_t works[TAPE_WORKS];  // bits 0..2 which piece, bit 3 before the step, from bit 4 windows that came before it
} tape_period_t;

typedef struct {
  tape_mode_t mode;
  bool stepping, stepped;  // the control step runs; has run
  bool playing;            // a window is being played
  bool working;            // a piece of the background's work has begun and not ended
  bool ended;              // the period has, while its step or a piece of work went on: what comes next is not its own
  uint16_t call;           // its hooked calls so far
  uint16_t input, window, work;  // played so far
  bool torn;                     // the tape was too short or too long for what the drive did
  void (*interrupt)(void);       // the window interrupt, played; while it records: takes the step that is on the tape
  tape_period_t period;
} hal_tape_t;

extern hal_tape_t hal_tape;

/// Mode and an empty period. interrupt: what a window that is played calls; while it records, who takes a step from the
/// tape when the next one begins, and turns to a new period.
void hal_tape_start(tape_mode_t mode, void (*interrupt)(void));

/// A new, empty period; when it plays the caller fills it in.
void hal_tape_next_period(void);

/// Plays the windows that came by now: those before the step, in a call of it, behind it.
void tape_play_windows(void);

/// Before the control step: windows that came before it are played, and their calls do not count. While it records, a
/// step that is still on the tape has to be taken from it first: the interrupt was so late that none has begun since.
void tape_begin_step(void);

/// Around the control step.
static inline void hal_tape_step_begin(void) {
  if (hal_tape.mode != TAPE_OFF) tape_begin_step();
  hal_tape.stepping = true;
}
static inline void hal_tape_step_end(void) {
  hal_tape.stepping = false;
  hal_tape.stepped = true;
}

/// Pieces of the background's work.
typedef enum {
  TAPE_RELOADED = 1,  // the configuration was made of changed parameters
  TAPE_EVALUATED = 2  // the commissioning went on
} tape_work_t;

/// Whether a piece that is wanted may be done now: always, but while the tape plays where it was done.
bool hal_tape_has_work(tape_work_t work);

/// Around a piece. While it records nobody may take a period from the tape in between, and no control step may begin.
void hal_tape_work_begin(tape_work_t work);
void hal_tape_work_end(void);

/// While it records, at the end of a period: whether its step is on the tape and nothing of it goes on. Otherwise it
/// has to be taken as soon as that is so, which the tape sees to.
bool hal_tape_end_period(void);

/// Windows not yet played are played; false when the period on the tape was not the one that ran.
bool hal_tape_finish_period(void);

// For the drivers.

static inline bool tape_is_off(void) { return hal_tape.mode == TAPE_OFF; }
static inline bool tape_plays(void) { return hal_tape.mode == TAPE_PLAYS; }

/// Begins a hooked call, behind what it tells and before anything that takes time: lets the interrupts come that came
/// in it.
void tape_pass_call(void);
static inline void tape_call(void) {
  if (!tape_is_off()) tape_pass_call();
}

/// A word that the HAL returns: played, or noted and handed through.
uint16_t tape_take(void);
uint16_t tape_note(uint16_t value);

/// What the HAL is told: what, and the words that belong to it.
typedef enum {
  TAPE_FRAME = 1,  // hal_pwm_write: rise, fall of the legs, bursts of the windows, deadline
  TAPE_GATES_ON = 2,
  TAPE_GATES_OFF = 3,
  TAPE_DEAD_BAND = 4,
  TAPE_ENABLE = 5,  // the gate enable line toggled
  TAPE_LAMP = 6,
  TAPE_SLICES = 7,  // slice time, 0 for windows again
  TAPE_LEGS = 8
} tape_told_t;

/// What does not fit is lost, and the tape torn.
void tape_tell(tape_told_t what, const uint16_t* words, uint16_t count);

/// Results of a window interrupt: played, or noted.
void tape_take_results(uint16_t* results, uint16_t count);
void tape_note_results(const uint16_t* results, uint16_t count);

#ifdef __cplusplus
}
#endif

#endif

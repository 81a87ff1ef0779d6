// Record and replay: what the hardware tells the drive, recorded here, played elsewhere.
//
// A period of the drive is a function of its state and of what the HAL returned in it. While a period is recorded, the
// HAL's functions work as ever and what they return and are told is noted. While it plays, they reach no register but
// for switching gates off and the lamp: they return what is in the recording, and what they are told is noted again, to
// be compared. So the interrupts of a drive can be stepped on a board whose power stage and sensors are elsewhere, in a
// simulation, and be compared word by word with another execution of the same C files. The gates cannot be switched on
// while a recording is played.
//
// Interrupts that came while the control step ran are put back into the same call of the HAL, so that they stand
// between the same two pieces of the drive's own code. What comes behind the control step is played behind it.
//
// The background level gets to its work when interrupts and other services let it: behind the step that asked for it or
// behind a later one, or even before a step whose interrupt is late. So each piece of it that the control step depends
// on has a word in the recording, and is done on the same side of the same step, between the same windows, when it is
// played.

#ifndef STILLSPIN_HAL_HAL_REPLAY_H
#define STILLSPIN_HAL_HAL_REPLAY_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define REPLAY_INPUTS 24u      // words that the HAL returns in a period
#define REPLAY_OUTPUTS 48u     // words that it is told
#define REPLAY_WINDOWS 20u     // window or slice interrupts in a period
#define REPLAY_RESULTS 6u      // words of one of them
#define REPLAY_WORKS 4u        // pieces of the background's work in a period
#define REPLAY_BEHIND 0xFFFFu  // `call` of a window that came behind the control step

typedef enum { REPLAY_OFF = 0, REPLAY_RECORDS = 1, REPLAY_PLAYS = 2 } replay_mode_t;

typedef struct {
  uint16_t call;  // hooked calls of the period's control step that had begun
  uint16_t results[REPLAY_RESULTS];
} replay_window_t;

/// One period.
typedef struct {
  uint16_t input_count, output_count, window_count, work_count;
  uint16_t inputs[REPLAY_INPUTS];
  uint16_t outputs[REPLAY_OUTPUTS];
  replay_window_t windows[REPLAY_WINDOWS];
  uint16_t works[REPLAY_WORKS];  // bits 0..2 which piece, bit 3 before the step, from bit 4 windows that came before it
} replay_period_t;

typedef struct {
  replay_mode_t mode;
  bool stepping, stepped;  // the control step runs; has run
  bool playing;            // a window is being played
  bool working;            // a piece of the background's work has begun and not ended
  bool ended;              // the period has, while its step or a piece of work went on: what comes next is not its own
  uint16_t call;           // its hooked calls so far
  uint16_t input, window, work;  // played so far
  bool torn;                     // the recording was too short or too long for what the drive did
  void (*interrupt)(void);  // the window interrupt, played; while it records: takes the step that is in the recording
} hal_replay_t;

extern hal_replay_t hal_replay;
extern replay_period_t hal_replay_period;

/// Mode and an empty period. interrupt: what a window that is played calls; while it records, who takes a step from the
/// recording when the next one begins, and turns to a new period.
void hal_replay_start(replay_mode_t mode, void (*interrupt)(void));

/// A new, empty period; when it plays the caller fills it in.
void hal_replay_next_period(void);

/// Plays the windows that came by now: those before the step, in a call of it, behind it.
void replay_play_windows(void);

/// Before the control step: windows that came before it are played, and their calls do not count. While it records, a
/// step that is still in the recording has to be taken from it first: the interrupt was so late that none has begun
/// since.
void replay_begin_step(void);

/// Around the control step.
static inline void hal_replay_step_begin(void) {
  if (hal_replay.mode != REPLAY_OFF) replay_begin_step();
  hal_replay.stepping = true;
}
static inline void hal_replay_step_end(void) {
  hal_replay.stepping = false;
  hal_replay.stepped = true;
}

/// Pieces of the background's work.
typedef enum {
  REPLAY_RELOADED = 1,  // the configuration was made of changed parameters
  REPLAY_EVALUATED = 2  // the commissioning went on
} replay_work_t;

/// Whether a piece that is wanted may be done now: always, but while the recording is played where it was done.
bool hal_replay_has_work(replay_work_t work);

/// Around a piece. While it records nobody may take a period from the recording in between, and no control step may
/// begin.
void hal_replay_work_begin(replay_work_t work);
void hal_replay_work_end(void);

/// While it records, at the end of a period: whether its step is in the recording and nothing of it goes on. Otherwise
/// it has to be taken as soon as that is so, which the recording sees to.
bool hal_replay_end_period(void);

/// Windows not yet played are played; false when the period in the recording was not the one that ran.
bool hal_replay_finish_period(void);

// For the drivers.

static inline bool replay_is_off(void) { return hal_replay.mode == REPLAY_OFF; }
static inline bool replay_plays(void) { return hal_replay.mode == REPLAY_PLAYS; }

/// Begins a hooked call, behind what it tells and before anything that takes time: lets the interrupts come that came
/// in it.
void replay_pass_call(void);
static inline void replay_call(void) {
  if (!replay_is_off()) replay_pass_call();
}

/// A word that the HAL returns: played, or noted and handed through.
uint16_t replay_take(void);
uint16_t replay_note(uint16_t value);

/// What the HAL is told: what, and the words that belong to it.
typedef enum {
  REPLAY_FRAME = 1,  // hal_pwm_write: rise, fall of the legs, bursts of the windows, deadline
  REPLAY_GATES_ON = 2,
  REPLAY_GATES_OFF = 3,
  REPLAY_DEAD_BAND = 4,
  REPLAY_ENABLE = 5,  // the gate enable line toggled
  REPLAY_LAMP = 6,
  REPLAY_SAMPLING_TIMER = 7,  // slice time, 0 for windows again
  REPLAY_LEGS = 8
} replay_output_t;

/// What does not fit is lost, and the recording torn.
void replay_output(replay_output_t what, const uint16_t* words, uint16_t count);

/// Results of a window interrupt: played, or noted.
void replay_take_results(uint16_t* results, uint16_t count);
void replay_note_results(const uint16_t* results, uint16_t count);

#ifdef __cplusplus
}
#endif

#endif

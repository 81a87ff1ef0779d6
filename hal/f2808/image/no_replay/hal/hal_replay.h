// In the place of hal/hal_replay.h for the drivers of an image without the host in the loop: nobody records or plays.

#ifndef STILLSPIN_HAL_HAL_REPLAY_H
#define STILLSPIN_HAL_HAL_REPLAY_H

#include <stdbool.h>
#include <stdint.h>

#define REPLAY_RESULTS 6u

typedef enum {
  REPLAY_FRAME,
  REPLAY_GATES_ON,
  REPLAY_GATES_OFF,
  REPLAY_DEAD_BAND,
  REPLAY_ENABLE,
  REPLAY_LAMP
} replay_output_t;

static inline bool replay_is_off(void) { return true; }
static inline bool replay_plays(void) { return false; }
static inline void replay_call(void) {}
static inline uint16_t replay_take(void) { return 0u; }
static inline uint16_t replay_note(uint16_t value) { return value; }

static inline void replay_output(replay_output_t what, const uint16_t* words, uint16_t count) {
  (void)what;
  (void)words;
  (void)count;
}

static inline void replay_take_results(uint16_t* results, uint16_t count) {
  for (uint16_t k = 0u; k < count; k++) results[k] = 0u;
}

static inline void replay_note_results(const uint16_t* results, uint16_t count) {
  (void)results;
  (void)count;
}

#endif

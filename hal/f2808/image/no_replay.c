// In the place of hal/replay.c in an image without the host in the loop, where nobody records or plays.

#include "hal/hal_replay.h"

hal_replay_t hal_replay;  // off for ever

void replay_begin_step(void) {}
void replay_pass_call(void) {}

bool hal_replay_has_work(replay_work_t work) {
  (void)work;
  return true;
}

void hal_replay_work_begin(replay_work_t work) { (void)work; }
void hal_replay_work_end(void) {}

uint16_t replay_take(void) { return 0u; }
uint16_t replay_note(uint16_t value) { return value; }

void replay_output(replay_output_t what, const uint16_t* words, uint16_t count) {
  (void)what;
  (void)words;
  (void)count;
}

void replay_take_results(uint16_t* results, uint16_t count) {
  for (uint16_t k = 0u; k < count; k++) results[k] = 0u;
}

void replay_note_results(const uint16_t* results, uint16_t count) {
  (void)results;
  (void)count;
}

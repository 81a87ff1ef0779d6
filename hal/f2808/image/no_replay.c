// In the place of hal/replay.c in an image without the host in the loop: what the drive asks, as its drivers ask
// nothing (no_replay/hal/hal_replay.h).

#include "hal/hal_replay.h"

hal_replay_t hal_replay;  // off for ever

void replay_begin_step(void) {}

bool hal_replay_has_work(replay_work_t work) {
  (void)work;
  return true;
}

void hal_replay_work_begin(replay_work_t work) { (void)work; }
void hal_replay_work_end(void) {}

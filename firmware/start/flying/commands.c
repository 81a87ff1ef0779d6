// look.

#include "firmware/start/flying/commands.h"

#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/start/flying/look.h"

static bool wait_for_look(uint16_t step) {
  (void)step;
  const look_outcome_t outcome = drive_look_outcome();
  if (outcome == LOOK_RUNNING) return true;
  put_look(line_begin());
  if (outcome == LOOK_ENDED) count_refusal();
  line_end();
  return false;
}

void command_look(const words_of_line_t* a) {
  if (!no_arguments(a) || !command_may_move(a)) return;
  if (action_look(line_begin()) == ANSWER_OK) {
    console_run(wait_for_look, false);
  } else {
    line_end_refused();
  }
}

#include "firmware/commissioning/actions.h"

#include "firmware/api/status.h"
#include "firmware/commissioning/outcome.h"

answer_status_t action_commission(comm_watchdog_t watchdog, uint32_t holder, octet_writer_t* why) {
  const answer_status_t status = action_may_begin(why);
  if (status != ANSWER_OK) return status;
  comm_watchdog_begin(watchdog, holder);
  drive_command_commission();
  return ANSWER_OK;
}

void commissioning_status_update(void) {
  feature_status.commissioning_outcome = (uint16_t)drive_commissioning_outcome();
  feature_status.commissioning_phase = (uint16_t)drive_commissioning_phase();
  feature_status.commissioning_progress = (uint16_t)drive_commissioning_progress();
}

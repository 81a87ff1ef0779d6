#include "firmware/start/flying/look.h"

#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

// What the last look at the shaft has shown.
static look_outcome_t look;
static int32_t look_rpm_q16;

// A start that ends where the shaft is seen.
static const state_request_t asked = {DRIVE_START, DRIVE_READY};

void look_reset(void) { drive_look_end(LOOK_NONE, 0); }

void drive_command_look(void) {
  look = LOOK_RUNNING;
  drive.request.begin = &asked;
}

// The end of a look writes its outcome; who breaks it off does not know of it.
look_outcome_t drive_look_outcome(void) {
  const bool goes_on =
      drive.request.begin == &asked || (drive.state == DRIVE_START && drive.flags.behind == DRIVE_READY);
  const look_outcome_t outcome = look;
  return (outcome == LOOK_RUNNING && !goes_on) ? LOOK_ENDED : outcome;
}

int32_t drive_look_rpm(void) { return look_rpm_q16; }

void drive_look_end(look_outcome_t outcome, int32_t rpm_q16) {
  look = outcome;
  look_rpm_q16 = rpm_q16;
}

answer_status_t action_look(octet_writer_t* why) {
  const answer_status_t status = action_may_begin(why);
  if (status == ANSWER_OK) drive_command_look();
  return status;
}

void put_look(octet_writer_t* w) {
  const look_outcome_t outcome = drive_look_outcome();
  put_message(w, CATALOGUE_LOOK, (uint16_t)outcome);
  if (outcome < LOOK_TURNS || outcome > LOOK_UNCLEAR) return;
  put_fixed(w, drive_look_rpm(), 16, 0);
  put_packed(w, SAY_rpm);
}

// start, stop, coast, ref, reset.

#include <stddef.h>

#include "firmware/api/actions.h"
#include "firmware/api/comm_watchdog.h"
#include "firmware/console/commands.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#define START_PATIENCE_MS 5000u

static uint32_t command_ms;

bool no_arguments(const words_of_line_t* a) {
  if (a->count == 0u) return true;
  line_refused(SAY_this_command_takes_nothing_after_it);
  return false;
}

static bool wait_for_run(uint16_t step) {
  const uint32_t waited = drive_time_ms() - command_ms;
  (void)step;
  if (drive.state == DRIVE_FAULT) {  // which the console tells unasked
    count_refusal();
    return false;
  }
  if (drive.state == DRIVE_RUN) {
    octet_writer_t* const w = line_begin();
    put_packed(w, SAY_running_after);
    put_count(w, waited, SAY_ms);
    line_end();
    return false;
  }
  if (waited < START_PATIENCE_MS) return true;
  line_refused(SAY_not_running_yet_see_status);
  return false;
}

bool choose_watchdog(const words_of_line_t* a, uint16_t k, comm_watchdog_t* watchdog) {
  if (a->count == k && comm_watchdog_beside_text() != 0u) {
    *watchdog = COMM_WATCHDOG_SERIAL;
  } else if (a->count == k + 1u && word_is(a, k, SAY_hold)) {
    *watchdog = COMM_WATCHDOG_KEYS;
  } else if (a->count == k + 1u && word_is(a, k, SAY_free)) {
    *watchdog = COMM_WATCHDOG_NONE;
  } else {
    line_refused(SAY_nothing_done_nobody_would_watch_add);
    return false;
  }
  return command_may_move(a);
}

void say_watchdog(comm_watchdog_t watchdog) {
  if (watchdog == COMM_WATCHDOG_KEYS) line_of(SAY_hold_runs_while_a_key_is_held);
  if (watchdog == COMM_WATCHDOG_NONE) line_of(SAY_free_nobody_watches_runs_until_stop);
}

void command_start(const words_of_line_t* a) {
  comm_watchdog_t watchdog;
  if (!choose_watchdog(a, 0, &watchdog)) return;
  if (watchdog == COMM_WATCHDOG_NONE && drive_is_energised() &&
      drive.state != DRIVE_STOP) {  // whoever held the motor leaves
    if (comm_watchdog_release()) {
      say_watchdog(watchdog);
    } else {
      line_refused(SAY_others_hold_the_motor);
    }
    return;
  }
  octet_writer_t* const w = line_begin();
  if (action_start(watchdog, comm_watchdog_beside_text(), w) != ANSWER_OK) {
    line_end_refused();
    return;
  }
  say_watchdog(watchdog);
  command_ms = drive_time_ms();
  console_run(wait_for_run, true);
}

// Whatever else the line says: it stops.
void command_stop(const words_of_line_t* a) {
  (void)a;
  const bool on = drive_is_energised();
  action_stop();
  line_of(on ? SAY_stopping : SAY_the_power_stage_is_off);
}

void command_coast(const words_of_line_t* a) {
  (void)a;
  action_coast();
  line_of(SAY_power_stage_off);
}

static void show_reference(void) {
  octet_writer_t* const w = line_begin();
  put_packed(w, SAY_ref);
  put_fixed(w, drive_commanded_speed(), 16, 2);
  put_packed(w, SAY_rpm);
  line_end();
}

static void take_speed(const words_of_line_t* a, const decimal_t* number, const word_t* typed) {
  int32_t rpm_q16;
  const bool fits = decimal_raw(number, 16, &rpm_q16);
  if (rpm_q16 != 0 && drive_is_energised() && !command_may_move(a)) return;
  octet_writer_t* const w = line_begin();
  if (!fits) {
    put_word(w, typed);
    put_speed_limit(w, SAY_rpm_is_beyond_speed_limit);
  } else if (action_speed(rpm_q16, w) == ANSWER_OK) {
    show_reference();
    return;
  }
  line_end_refused();
}

void command_ref(const words_of_line_t* a) {
  decimal_t number;
  if (a->count == 0u) {
    show_reference();
    return;
  }
  word_t typed = words_from(a, 0);
  const uint16_t length = number_with_unit(a, 0, TEXT_UNIT_RPM, &number);
  if (length > 0u) {
    typed.count = length;
    take_speed(a, &number, &typed);
  } else {
    octet_writer_t* const w = line_begin();
    put_word(w, &typed);
    put_packed(w, SAY_is_not_a_number_in);
    put_speed_limit(w, SAY_rpm_up_to_speed_limit);
    line_end_refused();
  }
}

void command_reset(const words_of_line_t* a) {
  if (!no_arguments(a)) return;
  line_answer(action_reset(line_begin()) == ANSWER_OK, SAY_cleared_the_current_offsets_are_calibrated_a);
}

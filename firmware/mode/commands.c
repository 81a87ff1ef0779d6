// Commands: what the background level leaves for the control interrupt.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"

void drive_parameters_changed(void) { drive.request.reload = true; }

static const state_request_t start_and_run = {DRIVE_START, DRIVE_RUN};

void drive_command_start(void) { drive.request.begin = &start_and_run; }

bool drive_start_is_asked(void) { return drive.request.begin == &start_and_run; }

// What was asked for before and not begun yet is not wanted any more: it must not outlive the stop that follows.
void drive_command_stop(void) {
  drive.request.begin = NULL;
  drive.request.stop = true;
}

void drive_command_coast(void) {
  drive.request.begin = NULL;
  drive.request.coast = true;
}

void drive_command_reset(void) { drive.request.reset = true; }

// The value first: as soon as it is asked for it is taken.
void drive_command_speed(int32_t rpm_q16) {
  drive.request.speed_rpm_q16 = rpm_q16;
  drive.request.speed = true;
}

// In this order: what is taken between the two looks stays where it was left, too.
int32_t drive_commanded_speed(void) {
  return drive.request.speed ? drive.request.speed_rpm_q16 : drive.control.command_rpm_q16;
}

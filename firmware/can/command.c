#include "firmware/can/command.h"

#include "firmware/api/comm_watchdog.h"
#include "firmware/can/messages.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"

#define ALIVE_MODULO 16u
#define CRC_AT 3u
#define RPM_Q16_PER_STEP 16384L  // a quarter of a revolution per minute

static void count(uint16_t* counter, uint16_t by) {
  *counter = (uint16_t)(*counter > 0xFFFFu - by ? 0xFFFFu : *counter + by);
}

void can_command_reset(can_command_t* c) {
  static const can_command_t empty = {0};
  *c = empty;
  c->mode = -1;  // unlike any
}

// False: damaged, another's, or the same once more.
static bool counts(can_command_t* c, const hal_can_frame_t* frame) {
  if (frame->length != (uint16_t)CAN_COMMAND_OCTETS) return false;
  if (can_get(frame, CAN_COMMAND_CRC) != (int32_t)can_crc8(frame, CRC_AT)) return false;
  const uint16_t alive = (uint16_t)can_get(frame, CAN_COMMAND_ALIVE);
  const uint16_t steps = (uint16_t)((alive - c->alive) % ALIVE_MODULO);
  if (c->heard && steps == 0u) return false;
  if (c->heard) count(&c->gaps, (uint16_t)(steps - 1u));
  c->alive = alive;
  return true;
}

// Also with the power stage off: a start that has not been taken yet is forgotten.
static void begin_to_stop(void) {
  if (drive.state != DRIVE_STOP) drive_command_stop();
}

// A run that was asked for while the drive was at fault, or while somebody else had it running, is not for later.
static void disarm_where_foreign(can_command_t* c) {
  if (drive.state == DRIVE_FAULT || (!c->commanding && drive_is_energised())) c->armed = false;
}

static void run(can_command_t* c, int32_t speed_steps) {
  disarm_where_foreign(c);
  const bool starts = c->armed && drive.state == DRIVE_READY;
  const bool running = c->commanding && drive.state != DRIVE_FAULT;
  if (starts || running) drive_command_speed(speed_steps * RPM_Q16_PER_STEP);
  if (!starts) return;
  c->armed = false;
  c->commanding = true;
  comm_watchdog_begin((parameters.can_reaction == CAN_REACTION_NONE) ? COMM_WATCHDOG_NONE : COMM_WATCHDOG_OWN, 0);
  drive_command_start();
}

static void obey(can_command_t* c, const hal_can_frame_t* frame) {
  const int32_t mode = can_get(frame, CAN_COMMAND_MODE);
  const bool changed = mode != c->mode;
  const bool clear_fault = can_get(frame, CAN_COMMAND_CLEAR_FAULT) != 0;
  if (clear_fault && !c->clear_fault && drive.state == DRIVE_FAULT) drive_command_reset();
  c->clear_fault = clear_fault;
  if (c->heard && mode == CAN_MODE_RUN && changed && !c->timed_out) c->armed = true;
  if (mode != CAN_MODE_RUN) c->armed = false;
  c->mode = mode;
  switch (mode) {
    case CAN_MODE_RUN:
      run(c, can_get(frame, CAN_COMMAND_SPEED));
      break;
    case CAN_MODE_STOP:
      if (changed || c->commanding) begin_to_stop();
      break;
    default:  // a mode that does not exist is no reason to go on
      if (changed || c->commanding) drive_command_coast();
      break;
  }
}

void can_command_take(can_command_t* c, const hal_can_frame_t* frame, uint32_t now_ms) {
  if (!counts(c, frame)) {
    count(&c->bad, 1u);
    return;
  }
  obey(c, frame);
  c->heard = true;
  c->timed_out = false;
  c->heard_ms = now_ms;
}

static void react(void) {
  if (parameters.can_reaction == CAN_REACTION_STOP) begin_to_stop();
  if (parameters.can_reaction == CAN_REACTION_COAST) drive_command_coast();
}

// The start is a request: until the control interrupt takes it, the drive is commanded but not energised. In this
// order: a request that has gone was carried out before the state is looked at.
static void follow_drive(can_command_t* c) {
  const bool requested = drive_start_is_asked();
  if (!requested && !drive_is_energised()) c->commanding = false;
}

void can_command_service(can_command_t* c, uint32_t now_ms) {
  follow_drive(c);
  disarm_where_foreign(c);
  if (!c->heard || c->timed_out) return;
  if (now_ms - c->heard_ms < (uint32_t)parameters.can_timeout) return;
  c->timed_out = true;
  c->armed = false;
  if (!c->commanding) return;
  c->commanding = parameters.can_reaction == CAN_REACTION_NONE;
  react();
}

#include "firmware/api/guard.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"

static guard_t guarded;
static uint32_t heard_ms;
static uint32_t fed_ms;  // the serial port's last record
static bool fed;         // within link_timeout
static bool energised;   // the start has been carried out
static bool stopped;

void guard_reset(void) {
  guarded = GUARD_NONE;
  fed = false;
  energised = false;
  stopped = false;
}

void guard_begin(guard_t port) {
  guarded = port;
  heard_ms = drive_time_ms();
  energised = false;
  stopped = false;
}

void guard_release(void) {
  if (guarded != GUARD_BUS) guarded = GUARD_NONE;
}

static bool is_over(uint32_t since_ms) { return drive_time_ms() - since_ms >= (uint32_t)parameters.link_timeout; }

bool guard_heard(guard_t port) {
  if (port == GUARD_SERIAL) {
    fed = true;
    fed_ms = drive_time_ms();
  }
  if (port == guarded) heard_ms = drive_time_ms();
  return port == guarded;
}

bool guard_is_fed(void) { return fed; }

void guard_service(void) {
  fed = fed && !is_over(fed_ms);
  if (guarded == GUARD_NONE) return;
  const bool now = drive_is_energised();
  if ((energised && !now) || drive_state() == DRIVE_FAULT) {
    guarded = GUARD_NONE;
    return;
  }
  energised = now;
  if (!is_over(heard_ms)) return;
  guarded = GUARD_NONE;
  stopped = energised;
  if (parameters.link_reaction == LINK_REACTION_COAST) {
    drive_command_coast();
  } else {
    drive_command_stop();
  }
}

bool guard_is_on(void) { return guarded != GUARD_NONE; }

bool guard_has_stopped(void) { return stopped; }

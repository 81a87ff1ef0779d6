#include "firmware/api/guard.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"

static guard_t guarded;
static uint32_t held_by;
static uint32_t heard_ms;
static uint32_t beside_text;  // the last number over the serial port, within link_timeout
static uint32_t beside_text_ms;
static bool energised;  // the start has been carried out
static bool stopped;

void guard_reset(void) {
  guarded = GUARD_NONE;
  beside_text = 0;
  energised = false;
  stopped = false;
}

void guard_begin(guard_t port, uint32_t holder) {
  guarded = port;
  held_by = holder;
  heard_ms = drive_time_ms();
  energised = false;
  stopped = false;
}

bool guard_release(void) {
  if (guarded == GUARD_BUS || guarded == GUARD_OWN) return false;
  guarded = GUARD_NONE;
  return true;
}

static bool is_over(uint32_t since_ms) { return drive_time_ms() - since_ms >= (uint32_t)parameters.link_timeout; }

void guard_heard(guard_t port, uint32_t holder) {
  if (port == GUARD_SERIAL) {
    beside_text = holder;
    beside_text_ms = drive_time_ms();
  }
  if (port == guarded && holder == held_by) heard_ms = drive_time_ms();
}

bool guard_key(void) {
  if (guarded == GUARD_KEYS) heard_ms = drive_time_ms();
  return guarded == GUARD_KEYS;
}

uint32_t guard_beside_text(void) { return beside_text; }

void guard_service(void) {
  if (is_over(beside_text_ms)) beside_text = 0;
  if (guarded == GUARD_NONE) return;
  const bool now = drive_is_energised();
  if ((energised && !now) || drive_state() == DRIVE_FAULT) {
    guarded = GUARD_NONE;
    return;
  }
  energised = now;
  if (guarded == GUARD_OWN || !is_over(heard_ms)) return;
  guarded = GUARD_NONE;
  stopped = energised;
  if (parameters.link_reaction == LINK_REACTION_COAST) {
    drive_command_coast();
  } else {
    drive_command_stop();
  }
}

bool guard_is_on(void) { return guarded != GUARD_NONE; }

bool guard_is_of(uint32_t holder) { return guard_is_on() && holder != 0u && holder == held_by; }

bool guard_has_stopped(void) { return stopped; }

#include "firmware/api/comm_watchdog.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"

static comm_watchdog_t watcher;
static uint32_t held_by;
static uint32_t heard_ms;
static uint32_t beside_text;  // the last number over the serial port, within link_timeout
static uint32_t beside_text_ms;
static bool energised;  // the start has been carried out
static bool stopped;

void comm_watchdog_reset(void) {
  watcher = COMM_WATCHDOG_NONE;
  beside_text = 0;
  energised = false;
  stopped = false;
}

void comm_watchdog_begin(comm_watchdog_t port, uint32_t holder) {
  watcher = port;
  held_by = holder;
  heard_ms = drive_time_ms();
  energised = false;
  stopped = false;
}

bool comm_watchdog_release(void) {
  if (watcher == COMM_WATCHDOG_BUS || watcher == COMM_WATCHDOG_OWN) return false;
  watcher = COMM_WATCHDOG_NONE;
  return true;
}

static bool is_over(uint32_t since_ms) { return drive_time_ms() - since_ms >= (uint32_t)parameters.link_timeout; }

void comm_watchdog_heard(comm_watchdog_t port, uint32_t holder) {
  if (port == COMM_WATCHDOG_SERIAL) {
    beside_text = holder;
    beside_text_ms = drive_time_ms();
  }
  if (port == watcher && holder == held_by) heard_ms = drive_time_ms();
}

bool comm_watchdog_key(void) {
  if (watcher == COMM_WATCHDOG_KEYS) heard_ms = drive_time_ms();
  return watcher == COMM_WATCHDOG_KEYS;
}

uint32_t comm_watchdog_beside_text(void) { return beside_text; }

void comm_watchdog_service(void) {
  if (is_over(beside_text_ms)) beside_text = 0;
  if (watcher == COMM_WATCHDOG_NONE) return;
  const bool now = drive_is_energised();
  if ((energised && !now) || drive_state() == DRIVE_FAULT) {
    watcher = COMM_WATCHDOG_NONE;
    return;
  }
  energised = now;
  if (watcher == COMM_WATCHDOG_OWN || !is_over(heard_ms)) return;
  watcher = COMM_WATCHDOG_NONE;
  stopped = energised;
  if (parameters.link_reaction == LINK_REACTION_COAST) {
    drive_command_coast();
  } else {
    drive_command_stop();
  }
}

bool comm_watchdog_is_on(void) { return watcher != COMM_WATCHDOG_NONE; }

bool comm_watchdog_is_of(uint32_t holder) { return comm_watchdog_is_on() && holder != 0u && holder == held_by; }

bool comm_watchdog_has_stopped(void) { return stopped; }

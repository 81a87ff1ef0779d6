#include "firmware/api/comm_watchdog.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"

typedef struct {
  uint32_t held_by;
  uint32_t heard_ms;
  uint32_t beside_text;  // the last number over the serial port, within link_timeout
  uint32_t beside_text_ms;
  comm_watchdog_t watcher;
  bool energised;  // the start has been carried out
  bool stopped;
} comm_watchdog_state_t;
static comm_watchdog_state_t self;

void comm_watchdog_reset(void) {
  static const comm_watchdog_state_t at_rest = {0};
  self = at_rest;
}

void comm_watchdog_begin(comm_watchdog_t port, uint32_t holder) {
  self.watcher = port;
  self.held_by = holder;
  self.heard_ms = drive_time_ms();
  self.energised = false;
  self.stopped = false;
}

bool comm_watchdog_release(void) {
  if (self.watcher == COMM_WATCHDOG_BUS || self.watcher == COMM_WATCHDOG_OWN) return false;
  self.watcher = COMM_WATCHDOG_NONE;
  return true;
}

static bool is_over(uint32_t since_ms) { return drive_time_ms() - since_ms >= (uint32_t)parameters.link_timeout; }

void comm_watchdog_heard(comm_watchdog_t port, uint32_t holder) {
  if (port == COMM_WATCHDOG_SERIAL) {
    self.beside_text = holder;
    self.beside_text_ms = drive_time_ms();
  }
  if (port == self.watcher && holder == self.held_by) self.heard_ms = drive_time_ms();
}

bool comm_watchdog_key(void) {
  if (self.watcher == COMM_WATCHDOG_KEYS) self.heard_ms = drive_time_ms();
  return self.watcher == COMM_WATCHDOG_KEYS;
}

uint32_t comm_watchdog_beside_text(void) { return self.beside_text; }

void comm_watchdog_service(void) {
  if (is_over(self.beside_text_ms)) self.beside_text = 0;
  if (self.watcher == COMM_WATCHDOG_NONE) return;
  const bool now = drive_is_energised();
  if ((self.energised && !now) || drive_state() == DRIVE_FAULT) {
    self.watcher = COMM_WATCHDOG_NONE;
    return;
  }
  self.energised = now;
  if (self.watcher == COMM_WATCHDOG_OWN || !is_over(self.heard_ms)) return;
  self.watcher = COMM_WATCHDOG_NONE;
  self.stopped = self.energised;
  if (parameters.link_reaction == LINK_REACTION_COAST) {
    drive_command_coast();
  } else {
    drive_command_stop();
  }
}

bool comm_watchdog_is_on(void) { return self.watcher != COMM_WATCHDOG_NONE; }

bool comm_watchdog_is_of(uint32_t holder) { return comm_watchdog_is_on() && holder != 0u && holder == self.held_by; }

bool comm_watchdog_has_stopped(void) { return self.stopped; }

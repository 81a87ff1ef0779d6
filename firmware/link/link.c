#include "firmware/link/link.h"

#include <stddef.h>

#include "firmware/api/comm_watchdog.h"
#include "firmware/interfaces/text_port.h"
#include "firmware/link/requests.h"
#include "firmware/link/stream.h"
#include "firmware/mode/commands.h"

#define OCTETS_A_ROUND 8u  // 115200 Bd bring little more than one in a period
#define WIRE_MAX (RECORD_ENCODED_MAX + 2u)
#if WIRE_MAX != RECORD_ON_WIRE_MAX
#error "text leaves another room for records than they take"
#endif
#define EVENT_WIRE_MAX (2u + 4u + 4u * STREAM_SIGNALS + 1u + 5u)  // with CRC, code octet and zeros

static struct {
  uint16_t text_at, text_end;  // text in the splitter's block that nobody has had yet
  splitter_t splitter;
  uint16_t wire[WIRE_MAX];
} self;
static uint16_t* const record = &self.wire[RECORD_IN_WIRE];

void link_reset(void) {
  comm_watchdog_reset();
  splitter_reset(&self.splitter);
  self.text_at = 0;
  self.text_end = 0;
  requests_reset();
  stream_reset();
}

// There has to be room.
static void send(uint16_t count) {
  if (count > 0u) (void)hal_sci_write(self.wire, record_to_wire(record, count, self.wire));
}

// Only into a ring that is all but empty, so that a stream too fast for the port leaves room for all else; the port's
// FIFO keeps the wire busy meanwhile. One that waits behind an answer comes late, not never: it is missed when the next
// one is due.
static void send_event(void) {
  if (hal_sci_room() >= EVENT_WIRE_MAX + WIRE_MAX + TEXT_LINE_MAX) send(stream_event(COMM_WATCHDOG_SERIAL, record));
}

static void answer(void) {  // take_octet has seen to the room
  send(request_answer(COMM_WATCHDOG_SERIAL, self.splitter.octets, self.splitter.count, record));
}

static void sort(int16_t found) {
  if (found == SPLITTER_RECORD) {
    if (edition_text_port != NULL && (self.splitter.octets[0] & 0xFFu) == REQUEST_IDENTITY)
      edition_text_port->give_way();
    answer();
  } else {
    self.text_at = 0;
    self.text_end = (edition_text_port != NULL) ? (uint16_t)found : 0u;
  }
}

// A break is the terminal's way to say that what came before does not count.
static void forget(void) {
  self.splitter.in_record = false;
  self.text_at = self.text_end;
  if (edition_text_port != NULL) edition_text_port->octet(TEXT_BREAK);
}

// One octet or character further; false when there is none, or no room for what it may bring about.
static bool take_octet(void) {
  uint16_t octet;
  if (hal_sci_take_break()) forget();
  if (hal_sci_room() < WIRE_MAX) return false;
  if (self.text_at < self.text_end) {
    if (!edition_text_port->takes()) return false;
    edition_text_port->octet(self.splitter.octets[self.text_at++]);
    return true;
  }
  if (hal_sci_read(&octet, 1) == 0u) {
    sort(splitter_rest(&self.splitter, drive_time_ms()));
    return false;
  }
  const int16_t found = splitter_octet(&self.splitter, octet, drive_time_ms());
  sort(found);
  return found != SPLITTER_RECORD;
}

void link_service(void) {
  comm_watchdog_service();
  requests_service(record);
  send_event();
  uint16_t left = OCTETS_A_ROUND;
  while (left > 0u && take_octet()) left--;
}

link_errors_t link_errors(void) {
  link_errors_t e;
  e.records = self.splitter.errors;
  e.port = hal_sci_errors();
  e.events_dropped = stream_lost(COMM_WATCHDOG_SERIAL);
  return e;
}

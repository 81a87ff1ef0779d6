// How the serial port is, in words.

#include "firmware/link/link.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

static void status_port(octet_writer_t* w) {
  const link_errors_t e = link_errors();
  put_count(w, (uint32_t)e.port.framing + e.port.overrun + e.port.breaks + e.port.lost, SAY_disturbances);
  put_count(w, (uint32_t)e.records.damaged + e.records.too_long + e.records.broken_off, SAY_damaged_records);
  put_count(w, e.events_dropped, SAY_events_dropped);
}

const status_line_t serial_line = {SAY_title_serial, status_port};

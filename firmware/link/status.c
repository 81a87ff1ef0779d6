// How the serial port is, in words.

#include "firmware/link/link.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

static void status_port(octet_writer_t* w) {
  const link_errors_t e = link_errors();
  put_unsigned(w, (uint32_t)e.port.framing + e.port.overrun + e.port.breaks + e.port.lost);
  put_packed(w, SAY_disturbances);
  put_unsigned(w, (uint32_t)e.records.damaged + e.records.too_long + e.records.broken_off);
  put_packed(w, SAY_damaged_records);
  put_unsigned(w, e.events_dropped);
  put_packed(w, SAY_events_dropped);
}

const status_line_t serial_line = {"serial", status_port};

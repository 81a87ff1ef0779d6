// The serial port: text for people, records for machines, on one wire (docs/protocol.md).
//
// link_service is called in every round of the background loop. It takes a few octets from the port, and a record or a
// line at most, and returns; nothing here waits. What is sent goes out whole or not at all, so that text and records
// never mix: a record or a line is begun only when the port's ring has room for all of it.

#ifndef STILLSPIN_FIRMWARE_LINK_LINK_H
#define STILLSPIN_FIRMWARE_LINK_LINK_H

#include <stdint.h>

#include "firmware/api/status.h"
#include "firmware/link/splitter.h"
#include "hal/hal_sci.h"

#if defined(__cplusplus)
extern "C" {
#endif

typedef struct {
  splitter_errors_t records;
  hal_sci_errors_t port;
  uint16_t events_dropped;
} link_errors_t;

/// Of records and port, each a word.
#define LINK_ERROR_COUNTS ((sizeof(splitter_errors_t) + sizeof(hal_sci_errors_t)) / sizeof(uint16_t))

/// Power-on state. The port itself is left alone.
void link_reset(void);

/// Background level.
void link_service(void);

link_errors_t link_errors(void);
extern const status_line_t serial_line;

#if defined(__cplusplus)
}
#endif

#endif

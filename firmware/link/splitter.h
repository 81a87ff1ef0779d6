// Tells text and records apart that come over the same wire, whatever comes.
//
// An octet of zero begins a record and the next one ends it; all others outside of records are text. Zeros in a row are
// one. A record that turns out to be none (malformed, wrong CRC) is dropped and counted, and its last zero is taken for
// the first one of the next: so a zero that was lost or one that a disturbance made costs one record and not the order
// of all that follow.
//
// A record that rests for SPLITTER_REST_MS, or becomes too long, is dropped, and text is expected again. If all of it
// is printable it was text behind a zero that nobody sent: it is handed out as such, nothing is lost.

#ifndef STILLSPIN_FIRMWARE_LINK_SPLITTER_H
#define STILLSPIN_FIRMWARE_LINK_SPLITTER_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/link/record.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define SPLITTER_REST_MS 100u

/// Records that were dropped; they stay at 65535.
typedef struct {
  uint16_t damaged;   // no encoding, or a wrong CRC
  uint16_t too_long;  // more than RECORD_ENCODED_MAX octets
  uint16_t broken_off;
} splitter_errors_t;

typedef enum {
  SPLITTER_RECORD = -1,  // octets[0..count) is a record without its CRC, to be used before the next octet
  SPLITTER_NOTHING = 0
  // n > 0: octets[0..n) is text
} splitter_found_t;

typedef struct {
  uint16_t count;
  bool in_record;
  bool skipping;  // a record that is too long, to its end
  uint32_t last_ms;
  splitter_errors_t errors;
  uint16_t octets[RECORD_ENCODED_MAX + 1u];
} splitter_t;

void splitter_reset(splitter_t* s);

/// Takes one octet; `now_ms` is a clock that may wrap. Returns a splitter_found_t or the number of octets of text.
int16_t splitter_octet(splitter_t* s, uint16_t octet, uint32_t now_ms);

/// To be called now and then while nothing comes. Returns as splitter_octet.
int16_t splitter_rest(splitter_t* s, uint32_t now_ms);

#if defined(__cplusplus)
}
#endif

#endif

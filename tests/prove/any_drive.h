// The drive as what is above it sees it: in any state, with any signals, at any time.

#ifndef STILLSPIN_TESTS_PROVE_ANY_DRIVE_H
#define STILLSPIN_TESTS_PROVE_ANY_DRIVE_H

#include "firmware/drive/signals.h"
#include "firmware/link/stream.h"
#include "firmware/mode/mode.h"
#include "tests/prove/any.h"

/// To be called wherever a control interrupt may have come.
void any_moment(void);

/// Somebody has asked for a stream.
static inline void any_stream(comm_watchdog_t port) {
  uint16_t places[STREAM_SIGNALS];
  for (uint16_t k = 0; k < STREAM_SIGNALS; k++) places[k] = any_up_to(signal_count() - 1u);
  stream_setup(port, any_u16, places, any_up_to(STREAM_SIGNALS));
}

static inline void any_octets(uint16_t* to, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) to[k] = any_u16;
}

#endif

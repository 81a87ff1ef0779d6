// The stream: some signals once every few milliseconds, as events on the port that asked for it. Each port has its own.
//
// An event that finds no room on its port, or whose time has passed meanwhile, is dropped and counted; its
// counter is used up, so that the host sees the gap. Nothing ever waits for the port.

#ifndef STILLSPIN_FIRMWARE_LINK_STREAM_H
#define STILLSPIN_FIRMWARE_LINK_STREAM_H

#include <stdint.h>

#include "firmware/api/comm_watchdog.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define STREAM_SIGNALS 8u
#define EVENT_STREAM 0x40u

void stream_reset(void);

/// `port`: COMM_WATCHDOG_SERIAL or COMM_WATCHDOG_BUS. Signals by their places in signal_list.h; period 0 ends the
/// stream.
void stream_setup(comm_watchdog_t port, uint16_t period_ms, const uint16_t* places, uint16_t count);

/// The record that is due, without its CRC, into `record` (room for RECORD_MAX). Returns its octets; 0 when none is
/// due.
uint16_t stream_event(comm_watchdog_t port, uint16_t* record);

/// To be told when an event found no room.
void stream_dropped(comm_watchdog_t port);

/// Events dropped since the stream was set up; stays at 65535.
uint16_t stream_lost(comm_watchdog_t port);

#if defined(__cplusplus)
}
#endif

#endif

// The communication watchdog: a drive that was started with it stops by itself when the one who started it is not heard
// any more.
//
// It is asked for with the start, belongs to who asked, and ends with the power stage. Every client draws a number for
// itself; being heard is a record over the same port with the number that the start had. What other programs ask does
// not count, nor does text. For a person at a terminal that sends no records the characters are counted instead:
// COMM_WATCHDOG_KEYS.

#ifndef STILLSPIN_FIRMWARE_API_COMM_WATCHDOG_H
#define STILLSPIN_FIRMWARE_API_COMM_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

/// COMM_WATCHDOG_OWN: who has started it watches by himself, such as the bus' COMMAND.
typedef enum {
  COMM_WATCHDOG_NONE = 0,
  COMM_WATCHDOG_SERIAL = 1,
  COMM_WATCHDOG_BUS = 2,
  COMM_WATCHDOG_KEYS = 3,
  COMM_WATCHDOG_OWN = 4
} comm_watchdog_t;

/// Values of the parameter link_reaction.
enum { LINK_REACTION_STOP = 1, LINK_REACTION_COAST = 2 };

void comm_watchdog_reset(void);

/// With the start; COMM_WATCHDOG_NONE takes the watchdog off. `holder`: the number of who asked, 0 for none.
void comm_watchdog_begin(comm_watchdog_t port, uint32_t holder);

/// Takes off a watchdog of the serial port, its keys' included. False for another's, which stays.
bool comm_watchdog_release(void);

/// A record with its sender's number came in from this port.
void comm_watchdog_heard(comm_watchdog_t port, uint32_t holder);

/// A character came in. True when the drive runs as long as they come.
bool comm_watchdog_key(void);

/// The number that has come over the serial port within link_timeout, to which a start that is typed beside it belongs;
/// 0 without one.
uint32_t comm_watchdog_beside_text(void);

/// Background level.
void comm_watchdog_service(void);

bool comm_watchdog_is_on(void);
bool comm_watchdog_is_of(uint32_t holder);

/// Since the last start.
bool comm_watchdog_has_stopped(void);

#if defined(__cplusplus)
}
#endif

#endif

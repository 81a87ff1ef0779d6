// The link's guard: a drive that was started with it stops by itself when the one who started it is not heard any more.
//
// It is asked for with the start, belongs to the port that the start came from, and ends with the power stage. Any
// record with a right CRC from that port counts as being heard; text does not. For a person at a terminal that sends no
// records the characters are counted instead: GUARD_KEYS.

#ifndef STILLSPIN_FIRMWARE_API_GUARD_H
#define STILLSPIN_FIRMWARE_API_GUARD_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum { GUARD_NONE = 0, GUARD_SERIAL = 1, GUARD_BUS = 2, GUARD_KEYS = 3 } guard_t;

/// Values of the parameter link_reaction.
enum { LINK_REACTION_STOP = 1, LINK_REACTION_COAST = 2 };

void guard_reset(void);

/// With the start; GUARD_NONE takes the guard off.
void guard_begin(guard_t port);

/// Takes off a guard of the serial port, its keys' included; one of the bus stays.
void guard_release(void);

/// A record came in from this port, or a character (GUARD_KEYS). True when the drive runs as long as they come.
bool guard_heard(guard_t port);

/// Records have come over the serial port within link_timeout: a start can be guarded by them.
bool guard_is_fed(void);

/// Background level.
void guard_service(void);

bool guard_is_on(void);

/// Since the last start.
bool guard_has_stopped(void);

#if defined(__cplusplus)
}
#endif

#endif

// The link's guard: a drive that was started with it stops by itself when the one who started it is not heard any more.
//
// It is asked for with the start, belongs to the port that the start came from, and ends with the power stage. Any
// record with a right CRC from that port counts as being heard; text does not.

#ifndef STILLSPIN_FIRMWARE_LINK_GUARD_H
#define STILLSPIN_FIRMWARE_LINK_GUARD_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum { GUARD_NONE = 0, GUARD_SERIAL = 1, GUARD_BUS = 2 } guard_t;

/// Values of the parameter link_reaction.
enum { LINK_REACTION_STOP = 1, LINK_REACTION_COAST = 2 };

void guard_reset(void);

/// With the start; GUARD_NONE takes the guard off.
void guard_begin(guard_t port);

/// A record came in from this port.
void guard_heard(guard_t port);

/// Background level.
void guard_service(void);

bool guard_is_on(void);

/// Since the last start.
bool guard_has_stopped(void);

#if defined(__cplusplus)
}
#endif

#endif

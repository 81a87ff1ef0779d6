// The link's guard: a drive that was started with it stops by itself when the one who started it is not heard any more.
//
// It is asked for with the start, belongs to who asked, and ends with the power stage. Every client draws a number for
// itself; being heard is a record over the same port with the number that the start had. What other programs ask does
// not count, nor does text. For a person at a terminal that sends no records the characters are counted instead:
// GUARD_KEYS.

#ifndef STILLSPIN_FIRMWARE_API_GUARD_H
#define STILLSPIN_FIRMWARE_API_GUARD_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

/// GUARD_OWN: who has started it watches by himself, such as the bus' COMMAND.
typedef enum { GUARD_NONE = 0, GUARD_SERIAL = 1, GUARD_BUS = 2, GUARD_KEYS = 3, GUARD_OWN = 4 } guard_t;

/// Values of the parameter link_reaction.
enum { LINK_REACTION_STOP = 1, LINK_REACTION_COAST = 2 };

void guard_reset(void);

/// With the start; GUARD_NONE takes the guard off. `holder`: the number of who asked, 0 for none.
void guard_begin(guard_t port, uint32_t holder);

/// Takes off a guard of the serial port, its keys' included. False for another's, which stays.
bool guard_release(void);

/// A record with its sender's number came in from this port.
void guard_heard(guard_t port, uint32_t holder);

/// A character came in. True when the drive runs as long as they come.
bool guard_key(void);

/// The number that has come over the serial port within link_timeout, to which a start that is typed beside it belongs;
/// 0 without one.
uint32_t guard_beside_text(void);

/// Background level.
void guard_service(void);

bool guard_is_on(void);
bool guard_is_of(uint32_t holder);

/// Since the last start.
bool guard_has_stopped(void);

#if defined(__cplusplus)
}
#endif

#endif

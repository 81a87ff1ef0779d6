// The requests of machines and their answers, whatever carries them: docs/protocol.md has the list.
//
// A request is type, tag and body, an answer type | 0x80, tag, status and body, both without the CRC of
// link/record.h. Every request is answered at once; what takes longer is begun by one and looked after by another. The
// answer to a request that is refused has the reason in words for its body, when there is one.

#ifndef STILLSPIN_FIRMWARE_LINK_REQUESTS_H
#define STILLSPIN_FIRMWARE_LINK_REQUESTS_H

#include "firmware/api/comm_watchdog.h"
#include "firmware/link/record.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// REQUEST_NAME, and COMMAND_NAME for the codes of REQUEST_COMMAND.
enum {
#define REQUEST(kind, name, number) kind##_##name = (number),
#include "firmware/link/all_requests.h"
#undef REQUEST
  REQUEST_NONE = 0
};

/// Power-on state.
void requests_reset(void);

/// Background level: works on the tables' check sum for a short time, with room for RECORD_BODY_MAX octets.
void requests_service(uint16_t* scratch);

/// Answers `count` octets of a request that came in at this port with a right CRC. Returns the number of octets of the
/// answer, for which there is room of RECORD_MAX; 0 for what is no request.
uint16_t request_answer(comm_watchdog_t port, const uint16_t* request, uint16_t count, uint16_t* answer);

#if defined(__cplusplus)
}
#endif

#endif

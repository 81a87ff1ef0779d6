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

enum {
  REQUEST_IDENTITY = 0x01,
  REQUEST_PARAMETER_INFO = 0x02,
  REQUEST_SIGNAL_INFO = 0x03,
  REQUEST_PARAMETER_READ = 0x04,
  REQUEST_PARAMETER_GET = 0x05,
  REQUEST_PARAMETER_SET = 0x06,
  REQUEST_COMMAND = 0x07,
  REQUEST_STATUS = 0x08,
  REQUEST_SIGNALS = 0x09,
  REQUEST_FAULT = 0x0A,
  REQUEST_WORDS = 0x0B,
  REQUEST_LINK = 0x0C,
  REQUEST_SCOPE_SETUP = 0x10,
  REQUEST_SCOPE_ARM = 0x11,
  REQUEST_SCOPE_STATE = 0x12,
  REQUEST_SCOPE_READ = 0x13,
  REQUEST_SCOPE_STOP = 0x14,
  REQUEST_STREAM = 0x15,
  REQUEST_COMMISSION_RESULT = 0x16,
  REQUEST_LOOK = 0x17,
  REQUEST_HIL_ENTER = 0x20,  // firmware/hil/hil.h
  REQUEST_HIL_STEP = 0x21,
  REQUEST_HIL_LEAVE = 0x22
};

/// Codes of REQUEST_COMMAND.
enum {
  COMMAND_START = 1,  // argument bit 0: watched over by the link, the whole is then the client's number
  COMMAND_STOP = 2,
  COMMAND_COAST = 3,
  COMMAND_RESET = 4,
  COMMAND_SPEED = 5,       // argument: rpm, Q16
  COMMAND_COMMISSION = 6,  // argument as COMMAND_START
  COMMAND_SAVE = 7,
  COMMAND_DEFAULTS = 8,
  COMMAND_LOAD = 9,
  COMMAND_LOOK = 10
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

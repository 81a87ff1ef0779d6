// What request_answer goes through: each feature's requests as rows of a table beside their handlers.

#ifndef STILLSPIN_FIRMWARE_LINK_REQUEST_ROWS_H
#define STILLSPIN_FIRMWARE_LINK_REQUEST_ROWS_H

#include "firmware/api/actions.h"
#include "firmware/base/octets.h"
#include "firmware/link/requests.h"

#if defined(__cplusplus)
extern "C" {
#endif

typedef struct {
  comm_watchdog_t port;
  octet_reader_t body;
  octet_writer_t answer;
} request_t;

/// The body has a length that the row allows; what it writes follows the answer's status.
typedef answer_status_t request_handler_t(request_t* r);

typedef struct {
  uint16_t type;  // or REQUEST_OF_COMMAND
  uint16_t body;  // octets: REQUEST_BODY
  request_handler_t* handler;
} request_row_t;

#define REQUEST_BODY(fewest, most) ((uint16_t)((fewest) | (most) << 8))
#define REQUEST_ROWS_END {0, 0, NULL}

/// The row of a code of REQUEST_COMMAND; its body is the argument alone.
#define REQUEST_OF_COMMAND(code) (0x100u + (code))
#define ARGUMENT_BODY REQUEST_BODY(4u, 4u)

/// Those of the edition, NULL behind the last one (editions/).
extern const request_row_t* const edition_requests[];

// The rows of the link's own files.
extern const request_row_t drive_requests[];      // requests_drive.c
extern const request_row_t parameter_requests[];  // requests_parameters.c
extern const request_row_t signal_requests[];     // requests_signals.c
extern const request_row_t table_requests[];      // requests_tables.c

/// Who watches over what a command starts, by its argument. False, and said, for a client without a number: that is a
/// former client, and nobody could tell who keeps it alive.
bool request_takes_watchdog(request_t* r, comm_watchdog_t* watchdog, uint32_t* holder);

#if defined(__cplusplus)
}
#endif

#endif

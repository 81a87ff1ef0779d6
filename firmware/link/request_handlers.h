// The handlers behind request_answer, by subject in requests_*.c. Their body has a length that the table allows; what
// they write follows the answer's status. Only for requests.c.

#ifndef STILLSPIN_FIRMWARE_LINK_REQUEST_HANDLERS_H
#define STILLSPIN_FIRMWARE_LINK_REQUEST_HANDLERS_H

#include "firmware/api/actions.h"
#include "firmware/base/octets.h"

typedef struct {
  guard_t port;
  octet_reader_t body;
  octet_writer_t answer;
} request_t;

typedef answer_status_t request_handler_t(request_t* r);

// requests_tables.c
request_handler_t request_identity, request_parameter_info, request_signal_info, request_words;
// requests_parameters.c
request_handler_t request_parameter_read, request_parameter_get, request_parameter_set;
// requests_drive.c
request_handler_t request_command, request_status, request_signals, request_fault, request_link,
    request_commission_result, request_look;
// hil/requests.c
request_handler_t request_hil_enter, request_hil_step, request_hil_leave;
// scope/requests.c
request_handler_t request_scope_setup, request_scope_arm, request_scope_state, request_scope_read, request_scope_stop,
    request_stream;

#endif

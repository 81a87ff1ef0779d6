#include "firmware/link/requests.h"

#include <stddef.h>

#include "firmware/link/request_handlers.h"

typedef struct {
  uint16_t type;
  uint16_t body;  // octets: the fewest, and the most in the upper half
  request_handler_t* handler;
} entry_t;

#define BODY(fewest, most) ((uint16_t)((fewest) | (most) << 8))

static const entry_t entries[] = {
    {REQUEST_IDENTITY, BODY(0, 0), request_identity},
    {REQUEST_PARAMETER_INFO, BODY(2, 2), request_parameter_info},
    {REQUEST_SIGNAL_INFO, BODY(2, 2), request_signal_info},
    {REQUEST_PARAMETER_READ, BODY(3, 3), request_parameter_read},
    {REQUEST_PARAMETER_GET, BODY(2, 2), request_parameter_get},
    {REQUEST_PARAMETER_SET, BODY(6, 6), request_parameter_set},
    {REQUEST_COMMAND, BODY(5, 5), request_command},
    {REQUEST_STATUS, BODY(0, 4), request_status},
    {REQUEST_SIGNALS, BODY(2, 32), request_signals},
    {REQUEST_FAULT, BODY(1, 1), request_fault},
    {REQUEST_WORDS, BODY(2, 2), request_words},
    {REQUEST_LINK, BODY(0, 0), request_link},
    {REQUEST_SCOPE_SETUP, BODY(16, 29), request_scope_setup},
    {REQUEST_SCOPE_ARM, BODY(0, 0), request_scope_arm},
    {REQUEST_SCOPE_STATE, BODY(0, 0), request_scope_state},
    {REQUEST_SCOPE_READ, BODY(4, 4), request_scope_read},
    {REQUEST_SCOPE_STOP, BODY(0, 0), request_scope_stop},
    {REQUEST_STREAM, BODY(2, 18), request_stream},
    {REQUEST_COMMISSION_RESULT, BODY(2, 2), request_commission_result},
    {REQUEST_LOOK, BODY(0, 0), request_look},
    {REQUEST_HIL_ENTER, BODY(0, 0), request_hil_enter},
    {REQUEST_HIL_STEP, BODY(3, RECORD_BODY_MAX), request_hil_step},
    {REQUEST_HIL_LEAVE, BODY(0, 0), request_hil_leave},
};

#define ENTRIES (sizeof entries / sizeof entries[0])

static const entry_t* find(uint16_t type) {
  for (uint16_t k = 0; k < ENTRIES; k++) {
    if (entries[k].type == type) return &entries[k];
  }
  return NULL;
}

static answer_status_t handle(request_t* r, uint16_t type) {
  const entry_t* const entry = find(type);
  if (entry == NULL) return ANSWER_UNKNOWN;
  if (r->body.count < (entry->body & 0xFFu) || r->body.count > entry->body >> 8) return ANSWER_LENGTH;
  return entry->handler(r);
}

uint16_t request_answer(guard_t port, const uint16_t* request, uint16_t count, uint16_t* answer) {
  if (count < 2u) return 0;
  const uint16_t type = request[0] & 0xFFu;
  if ((type & RECORD_ANSWER) != 0u) return 0;  // an answer that comes back must not be answered
  request_t r;
  r.port = port;
  r.body = octet_reader(&request[2], (uint16_t)(count - 2u));
  r.answer = octet_writer(&answer[3], RECORD_BODY_MAX);
  answer[0] = type | RECORD_ANSWER;
  answer[1] = request[1] & 0xFFu;
  answer[2] = (uint16_t)handle(&r, type);
  return (uint16_t)(r.answer.count + 3u);
}

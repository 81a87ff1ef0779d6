#include "firmware/link/requests.h"

#include <stddef.h>

#include "firmware/base/edition.h"
#include "firmware/link/request_rows.h"
#include "firmware/text/catalogue.h"

#define COMMAND_BODY 5u  // code and argument

static const request_row_t* find(uint16_t type) {
  for (uint16_t k = 0; edition_requests[k] != NULL; k++) {
    for (const request_row_t* row = edition_requests[k]; row->handler != NULL; row++) {
      if (row->type == type) return row;
    }
  }
  return NULL;
}

static answer_status_t handle(request_t* r, uint16_t type) {
  if (type == REQUEST_COMMAND) {
    if (r->body.count != COMMAND_BODY) return ANSWER_LENGTH;
    type = REQUEST_OF_COMMAND(take_u8(&r->body));
  }
  const request_row_t* const row = find(type);
  const uint16_t count = octets_left(&r->body);
  if (row == NULL) return rows_have(edition_requests_left_out, type) ? ANSWER_EDITION : ANSWER_UNKNOWN;
  if (count < (row->body & 0xFFu) || count > row->body >> 8) return ANSWER_LENGTH;
  return row->handler(r);
}

// Whoever refuses with it has written nothing.
static void put_edition(octet_writer_t* w) {
  put_message(w, CATALOGUE_STATUS, (uint16_t)ANSWER_EDITION);
  put_packed(w, SAY_comma);
  put_text(w, edition_name);
}

uint16_t request_answer(comm_watchdog_t port, const uint16_t* request, uint16_t count, uint16_t* answer) {
  if (count < 2u) return 0;
  const uint16_t type = request[0] & 0xFFu;
  if ((type & RECORD_ANSWER) != 0u) return 0;  // an answer that comes back must not be answered
  request_t r;
  r.port = port;
  r.body = octet_reader(&request[2], (uint16_t)(count - 2u));
  r.answer = octet_writer(&answer[3], RECORD_BODY_MAX);
  answer[0] = type | RECORD_ANSWER;
  answer[1] = request[1] & 0xFFu;
  const answer_status_t status = handle(&r, type);
  if (status == ANSWER_EDITION) put_edition(&r.answer);
  answer[2] = (uint16_t)status;
  return (uint16_t)(r.answer.count + 3u);
}

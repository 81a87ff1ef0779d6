// Values of the signals: once, and as a stream.

#include <stddef.h>

#include "firmware/drive/signals.h"
#include "firmware/link/request_rows.h"
#include "firmware/link/stream.h"

#define SIGNALS_MAX 16u

// The places of signals to the end of the body.
static answer_status_t take_places(request_t* r, uint16_t* places, uint16_t count) {
  if (r->body.count % 2u != 0u) return ANSWER_LENGTH;
  for (uint16_t k = 0; k < count; k++) {
    places[k] = take_u16(&r->body);
    if (places[k] >= signal_count()) return ANSWER_RANGE;
    if (signal_is_left_out(places[k])) return ANSWER_EDITION;
  }
  return ANSWER_OK;
}

static answer_status_t request_signals(request_t* r) {
  uint16_t places[SIGNALS_MAX] = {0};
  int32_t values[SIGNALS_MAX] = {0};
  const uint16_t count = r->body.count / 2u;
  const answer_status_t status = take_places(r, places, count);
  if (status != ANSWER_OK) return status;
  const signals_seen_t seen = drive_signals_copy(places, count, values);
  for (uint16_t k = 0; k < count; k++) put_i32(&r->answer, values[k]);
  put_u8(&r->answer, seen.known);
  return ANSWER_OK;
}

static answer_status_t request_stream(request_t* r) {
  uint16_t places[STREAM_SIGNALS] = {0};
  const uint16_t period_ms = take_u16(&r->body);
  const uint16_t count = (uint16_t)(octets_left(&r->body) / 2u);
  const answer_status_t status = take_places(r, places, count);
  if (status != ANSWER_OK) return status;
  if (period_ms != 0u && count == 0u) return ANSWER_LENGTH;
  stream_setup(r->port, period_ms, places, count);
  return ANSWER_OK;
}

const request_row_t signal_requests[] = {{REQUEST_SIGNALS, REQUEST_BODY(2u, 2u * SIGNALS_MAX), request_signals},
                                         {REQUEST_STREAM, REQUEST_BODY(2u, 2u + 2u * STREAM_SIGNALS), request_stream},
                                         REQUEST_ROWS_END};

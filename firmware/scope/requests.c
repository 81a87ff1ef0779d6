#include "firmware/scope/requests.h"

#include <stddef.h>

#include "firmware/drive/signals.h"
#include "firmware/scope/scope.h"
#include "firmware/text/packed_text.h"

#define CHANNEL_OCTETS 3u
#define HEAD_OCTETS 13u
#define HYSTERESIS_OCTETS 4u
#define READ_MAX 100u

static answer_status_t request_scope_setup(request_t* r) {
  octet_reader_t* const b = &r->body;
  scope_setup_t s = {0};
  s.decimation = take_u16(b);
  s.pretrigger = take_u16(b);
  const uint16_t mode = take_u8(b);
  const uint16_t edge = take_u8(b);
  s.trigger = take_u16(b);
  if (signal_is_left_out(s.trigger)) return ANSWER_EDITION;
  s.level = take_i32(b);
  s.count = take_u8(b);
  const uint16_t least = (uint16_t)(HEAD_OCTETS + CHANNEL_OCTETS * s.count);
  if (b->count != least && b->count != least + HYSTERESIS_OCTETS) return ANSWER_LENGTH;
  if (mode > SCOPE_AUTO || edge > SCOPE_BELOW) return ANSWER_RANGE;
  s.mode = (scope_mode_t)mode;
  s.edge = (scope_edge_t)edge;
  for (uint16_t k = 0; k < SCOPE_CHANNELS; k++) {
    if (k >= s.count) break;
    s.channel[k].signal = take_u16(b);
    if (signal_is_left_out(s.channel[k].signal)) return ANSWER_EDITION;
    s.channel[k].shift = take_u8(b);
  }
  s.hysteresis = (octets_left(b) > 0u) ? take_i32(b) : SCOPE_BY_SPAN;
  return scope_setup(&s) ? ANSWER_OK : ANSWER_RANGE;
}

static answer_status_t request_scope_arm(request_t* r) {
  if (scope_arm()) return ANSWER_OK;
  put_packed(&r->answer, SAY_the_scope_is_not_set_up_yet);
  return ANSWER_STATE;
}

static answer_status_t request_scope_state(request_t* r) {
  const scope_status_t s = scope_status();
  put_u8(&r->answer, (uint16_t)s.state);
  put_u16(&r->answer, s.recorded);
  put_u16(&r->answer, s.trigger_at);
  put_u32(&r->answer, s.trigger_time_ms);
  return ANSWER_OK;
}

// While a capture runs there is nothing to read: the answer is empty.
static answer_status_t request_scope_read(request_t* r) {
  int16_t words[READ_MAX] = {0};
  const uint16_t channel = take_u8(&r->body);
  const uint16_t offset = take_u16(&r->body);
  const uint16_t count = take_u8(&r->body);
  if (channel >= SCOPE_CHANNELS || offset >= SCOPE_DEPTH || count > READ_MAX) return ANSWER_RANGE;
  const uint16_t there = scope_read(channel, offset, words, count);
  for (uint16_t k = 0; k < there; k++) put_u16(&r->answer, (uint16_t)words[k]);
  return ANSWER_OK;
}

static answer_status_t request_scope_stop(request_t* r) {
  (void)r;
  scope_stop();
  return ANSWER_OK;
}

const request_row_t scope_requests[] = {{REQUEST_SCOPE_SETUP, REQUEST_BODY(16u, 29u), request_scope_setup},
                                        {REQUEST_SCOPE_ARM, REQUEST_BODY(0u, 0u), request_scope_arm},
                                        {REQUEST_SCOPE_STATE, REQUEST_BODY(0u, 0u), request_scope_state},
                                        {REQUEST_SCOPE_READ, REQUEST_BODY(4u, 4u), request_scope_read},
                                        {REQUEST_SCOPE_STOP, REQUEST_BODY(0u, 0u), request_scope_stop},
                                        REQUEST_ROWS_END};

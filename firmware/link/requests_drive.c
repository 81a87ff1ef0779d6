// Commands, and how the drive is.

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/drive/signals.h"
#include "firmware/link/link.h"
#include "firmware/link/request_rows.h"
#include "firmware/link/stream.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/mode.h"

bool request_takes_watchdog(request_t* r, comm_watchdog_t* watchdog, uint32_t* holder) {
  *holder = take_u32(&r->body);
  *watchdog = ((*holder & 1u) != 0u) ? r->port : COMM_WATCHDOG_NONE;
  if (*holder != 1u) return true;
  put_packed(&r->answer, SAY_a_guarded_start_needs_the_number);
  return false;
}

static answer_status_t request_start(request_t* r) {
  comm_watchdog_t watchdog;
  uint32_t holder;
  return request_takes_watchdog(r, &watchdog, &holder) ? action_start(watchdog, holder, &r->answer) : ANSWER_RANGE;
}

static answer_status_t request_stop(request_t* r) {
  (void)r;
  action_stop();
  return ANSWER_OK;
}

static answer_status_t request_coast(request_t* r) {
  (void)r;
  action_coast();
  return ANSWER_OK;
}

static answer_status_t request_reset(request_t* r) { return action_reset(&r->answer); }

static answer_status_t request_speed(request_t* r) { return action_speed(take_i32(&r->body), &r->answer); }

static uint16_t link_flags(uint32_t asker) {
  return (uint16_t)((comm_watchdog_is_on() ? 1u : 0u) | (comm_watchdog_has_stopped() ? 2u : 0u) |
                    (comm_watchdog_is_of(asker) ? 4u : 0u));
}

static answer_status_t request_status(request_t* r) {
  octet_writer_t* const w = &r->answer;
  const uint32_t asker = (r->body.count > 0u) ? take_u32(&r->body) : 0u;
  if (r->body.short_of) return ANSWER_LENGTH;
  if (asker != 0u) comm_watchdog_heard(r->port, asker);
  status_update();
  const drive_signals_t s = drive_signals();
  put_u32(w, drive_time_ms());
  put_u8(w, (uint16_t)drive.state);
  put_u8(w, (uint16_t)drive.fault);
  put_u16(w, (uint16_t)s.limit);
  put_i32(w, s.speed);
  put_i32(w, s.speed_reference);
  put_u8(w, feature_status.store_state);
  put_u8(w, feature_status.store_progress);
  put_u8(w, feature_status.commissioning_outcome);
  put_u8(w, feature_status.commissioning_phase);
  put_u16(w, feature_status.commissioning_progress);
  put_u8(w, link_flags(asker));
  put_u8(w, drive_known(&drive));
  put_u8(w, feature_status.unsaved);
  return ANSWER_OK;
}

static answer_status_t request_fault(request_t* r) {
  fault_record_t f;
  if (!fault_history_read(take_u8(&r->body), &f)) return ANSWER_RANGE;
  octet_writer_t* const w = &r->answer;
  put_u16(w, fault_history_total());
  put_u32(w, f.time_ms);
  put_u8(w, (uint16_t)f.fault);
  put_u8(w, (uint16_t)f.state);
  put_i32(w, f.speed_q16);
  put_i32(w, f.link_q16);
  put_i32(w, f.current_d_q20);
  put_i32(w, f.current_q_q20);
  put_u8(w, f.known);
  return ANSWER_OK;
}

static answer_status_t request_link(request_t* r) {
  const link_errors_t e = link_errors();
  octet_writer_t* const w = &r->answer;
  const uint16_t* const counts = (const uint16_t*)(const void*)&e;  // in the struct's order
  for (uint16_t k = 0; k < LINK_ERROR_COUNTS; k++) put_u16(w, counts[k]);
  put_u16(w, stream_lost(r->port));
  put_u16(w, feature_status.refusals);
  return ANSWER_OK;
}

const request_row_t drive_requests[] = {{REQUEST_STATUS, REQUEST_BODY(0u, 4u), request_status},
                                        {REQUEST_FAULT, REQUEST_BODY(1u, 1u), request_fault},
                                        {REQUEST_LINK, REQUEST_BODY(0u, 0u), request_link},
                                        {REQUEST_OF_COMMAND(COMMAND_START), ARGUMENT_BODY, request_start},
                                        {REQUEST_OF_COMMAND(COMMAND_STOP), ARGUMENT_BODY, request_stop},
                                        {REQUEST_OF_COMMAND(COMMAND_COAST), ARGUMENT_BODY, request_coast},
                                        {REQUEST_OF_COMMAND(COMMAND_RESET), ARGUMENT_BODY, request_reset},
                                        {REQUEST_OF_COMMAND(COMMAND_SPEED), ARGUMENT_BODY, request_speed},
                                        REQUEST_ROWS_END};

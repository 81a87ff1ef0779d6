// Commands, and how the drive is.

#include "firmware/commissioning/outcome.h"
#include "firmware/console/output.h"
#include "firmware/drive/signals.h"
#include "firmware/link/link.h"
#include "firmware/link/request_handlers.h"
#include "firmware/link/requests.h"
#include "firmware/link/stream.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/mode.h"
#include "firmware/store/store.h"

// A guard that is asked for without a number is a former client's: nobody could tell who keeps it alive.
static bool lacks_holder(uint16_t code, uint32_t number, octet_writer_t* why) {
  if (number != 1u || (code != COMMAND_START && code != COMMAND_COMMISSION)) return false;
  put_packed(why, SAY_a_guarded_start_needs_the_number);
  return true;
}

answer_status_t request_command(request_t* r) {
  const uint16_t code = take_u8(&r->body);
  const int32_t argument = take_i32(&r->body);
  const uint32_t holder = (uint32_t)argument;
  const guard_t guard = ((holder & 1u) != 0u) ? r->port : GUARD_NONE;
  if (lacks_holder(code, holder, &r->answer)) return ANSWER_RANGE;
  switch (code) {
    case COMMAND_START:
      return action_start(guard, holder, &r->answer);
    case COMMAND_STOP:
      action_stop();
      return ANSWER_OK;
    case COMMAND_COAST:
      action_coast();
      return ANSWER_OK;
    case COMMAND_RESET:
      return action_reset(&r->answer);
    case COMMAND_SPEED:
      return action_speed(argument, &r->answer);
    case COMMAND_COMMISSION:
      return action_commission(guard, holder, &r->answer);
    case COMMAND_SAVE:
      return action_save(&r->answer);
    case COMMAND_DEFAULTS:
      return action_defaults(&r->answer);
    case COMMAND_LOAD:
      return action_load(&r->answer);
    case COMMAND_LOOK:
      return action_look(&r->answer);
    default:
      return ANSWER_UNKNOWN;
  }
}

answer_status_t request_look(request_t* r) {
  put_u8(&r->answer, (uint16_t)drive_look_outcome());
  put_i32(&r->answer, drive_look_rpm());
  put_look(&r->answer);
  return ANSWER_OK;
}

static uint16_t link_flags(uint32_t asker) {
  return (uint16_t)((guard_is_on() ? 1u : 0u) | (guard_has_stopped() ? 2u : 0u) | (guard_is_of(asker) ? 4u : 0u));
}

answer_status_t request_status(request_t* r) {
  octet_writer_t* const w = &r->answer;
  const uint32_t asker = (r->body.count > 0u) ? take_u32(&r->body) : 0u;
  if (r->body.short_of) return ANSWER_LENGTH;
  if (asker != 0u) guard_heard(r->port, asker);
  const drive_signals_t s = drive_signals();
  put_u32(w, drive_time_ms());
  put_u8(w, (uint16_t)drive.state);
  put_u8(w, (uint16_t)drive.fault);
  put_u16(w, (uint16_t)s.limit);
  put_i32(w, s.speed);
  put_i32(w, s.speed_reference);
  put_u8(w, (uint16_t)store_state());
  put_u8(w, store_progress());
  put_u8(w, (uint16_t)drive_commissioning_outcome());
  put_u8(w, (uint16_t)drive_commissioning_phase());
  put_u16(w, (uint16_t)drive_commissioning_progress());
  put_u8(w, link_flags(asker));
  put_u8(w, drive_known(&drive));
  put_u8(w, store_unsaved());
  return ANSWER_OK;
}

#define SIGNALS_MAX 16u

answer_status_t request_signals(request_t* r) {
  uint16_t places[SIGNALS_MAX] = {0};
  int32_t values[SIGNALS_MAX] = {0};
  if (r->body.count % 2u != 0u) return ANSWER_LENGTH;
  const uint16_t count = r->body.count / 2u;
  for (uint16_t k = 0; k < count; k++) {
    places[k] = take_u16(&r->body);
    if (places[k] >= signal_count()) return ANSWER_RANGE;
  }
  const signals_seen_t seen = drive_signals_copy(places, count, values);
  for (uint16_t k = 0; k < count; k++) put_i32(&r->answer, values[k]);
  put_u8(&r->answer, seen.known);
  return ANSWER_OK;
}

answer_status_t request_fault(request_t* r) {
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

answer_status_t request_link(request_t* r) {
  const link_errors_t e = link_errors();
  octet_writer_t* const w = &r->answer;
  put_u16(w, e.records.damaged);
  put_u16(w, e.records.too_long);
  put_u16(w, e.records.broken_off);
  put_u16(w, e.port.framing);
  put_u16(w, e.port.overrun);
  put_u16(w, e.port.breaks);
  put_u16(w, e.port.lost);
  put_u16(w, stream_lost(r->port));
  put_u16(w, refusals());
  return ANSWER_OK;
}

answer_status_t request_commission_result(request_t* r) {
  const uint16_t index = take_u16(&r->body);
  put_u16(&r->answer, drive_commissioning_count());
  if (index >= drive_commissioning_count()) return ANSWER_OK;  // there is no such one: the number alone
  const commissioning_result_t v = drive_commissioning_result(index);
  put_u16(&r->answer, v.id);
  put_i32(&r->answer, v.before);
  put_i32(&r->answer, v.value);
  put_u8(&r->answer, (uint16_t)v.verdict);
  return ANSWER_OK;
}

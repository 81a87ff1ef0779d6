#include "firmware/commissioning/requests.h"

#include <stddef.h>

#include "firmware/commissioning/actions.h"
#include "firmware/commissioning/outcome.h"

static answer_status_t request_commission(request_t* r) {
  comm_watchdog_t watchdog;
  uint32_t holder;
  return request_takes_watchdog(r, &watchdog, &holder) ? action_commission(watchdog, holder, &r->answer) : ANSWER_RANGE;
}

static answer_status_t request_commission_result(request_t* r) {
  const uint16_t index = take_u16(&r->body);
  put_u16(&r->answer, drive_commissioning_count());
  const commissioning_result_t* const v = drive_commissioning_result(index);
  if (v == NULL) return ANSWER_OK;  // there is no such one: the number alone
  put_u16(&r->answer, v->id);
  put_i32(&r->answer, v->before);
  put_i32(&r->answer, v->value);
  put_u8(&r->answer, (uint16_t)v->verdict);
  return ANSWER_OK;
}

const request_row_t commissioning_requests[] = {
    {REQUEST_OF_COMMAND(COMMAND_COMMISSION), ARGUMENT_BODY, request_commission},
    {REQUEST_COMMISSION_RESULT, REQUEST_BODY(2u, 2u), request_commission_result},
    REQUEST_ROWS_END};

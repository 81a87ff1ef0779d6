// Values of the parameters.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/link/request_rows.h"

#define READ_MAX 32u

// Why there is no parameter of that number.
static answer_status_t refuse(uint16_t id) { return parameter_is_left_out(id) ? ANSWER_EDITION : ANSWER_UNKNOWN; }

static answer_status_t request_parameter_read(request_t* r) {
  const uint16_t first = take_u16(&r->body);
  const uint16_t count = take_u8(&r->body);
  if (count > READ_MAX || first >= parameter_count()) return ANSWER_RANGE;
  for (uint16_t k = 0; k < count; k++) {
    const parameter_info_t* const p = parameter_info((uint16_t)(first + k));
    if (p == NULL) break;
    put_u16(&r->answer, p->id);
    put_i32(&r->answer, *parameter_in_use(p));
  }
  return ANSWER_OK;
}

static answer_status_t request_parameter_get(request_t* r) {
  const uint16_t id = take_u16(&r->body);
  if (parameter_by_id(id) == NULL) return refuse(id);
  put_i32(&r->answer, parameter_get(id));
  return ANSWER_OK;
}

static answer_status_t request_parameter_set(request_t* r) {
  const uint16_t id = take_u16(&r->body);
  const parameter_info_t* const p = parameter_by_id(id);
  if (p == NULL) return refuse(id);
  const answer_status_t status = action_set(p, take_i32(&r->body), &r->answer);
  if (status == ANSWER_OK) put_i32(&r->answer, *parameter_in_use(p));
  return status;
}

const request_row_t parameter_requests[] = {{REQUEST_PARAMETER_READ, REQUEST_BODY(3u, 3u), request_parameter_read},
                                            {REQUEST_PARAMETER_GET, REQUEST_BODY(2u, 2u), request_parameter_get},
                                            {REQUEST_PARAMETER_SET, REQUEST_BODY(6u, 6u), request_parameter_set},
                                            REQUEST_ROWS_END};

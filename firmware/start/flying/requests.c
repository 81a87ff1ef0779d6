#include "firmware/start/flying/requests.h"

#include <stddef.h>

#include "firmware/start/flying/look.h"

static answer_status_t request_begin_look(request_t* r) { return action_look(&r->answer); }

static answer_status_t request_look(request_t* r) {
  put_u8(&r->answer, (uint16_t)drive_look_outcome());
  put_i32(&r->answer, drive_look_rpm());
  put_look(&r->answer);
  return ANSWER_OK;
}

const request_row_t look_requests[] = {{REQUEST_LOOK, REQUEST_BODY(0u, 0u), request_look},
                                       {REQUEST_OF_COMMAND(COMMAND_LOOK), ARGUMENT_BODY, request_begin_look},
                                       REQUEST_ROWS_END};

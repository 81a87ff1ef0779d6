#include "firmware/hil/requests.h"

#include <stddef.h>

#include "firmware/hil/hil.h"
#include "firmware/text/packed_text.h"

static answer_status_t said(request_t* r, hil_result_t result) {
  switch (result) {
    case HIL_OK:
      return ANSWER_OK;
    case HIL_ENERGISED:
      put_packed(&r->answer, SAY_the_power_stage_is_on_stop_first);
      return ANSWER_RUNNING;
    case HIL_BUSY:
      put_packed(&r->answer, SAY_parameters_are_being_saved_or_read_try);
      return ANSWER_BUSY;
    case HIL_NOT_ACTIVE:
      put_packed(&r->answer, SAY_not_in_host_in_the_loop_mode);
      return ANSWER_STATE;
    case HIL_SEQUENCE:
      put_u16(&r->answer, hil_expected());
      return ANSWER_CONFLICT;
    default:
      return ANSWER_LENGTH;
  }
}

static answer_status_t request_hil_enter(request_t* r) { return said(r, hil_enter()); }

static answer_status_t request_hil_step(request_t* r) { return said(r, hil_step(&r->body, &r->answer)); }

static answer_status_t request_hil_leave(request_t* r) { return said(r, hil_leave()); }

const request_row_t hil_requests[] = {{REQUEST_HIL_ENTER, REQUEST_BODY(0u, 0u), request_hil_enter},
                                      {REQUEST_HIL_STEP, REQUEST_BODY(3u, RECORD_BODY_MAX), request_hil_step},
                                      {REQUEST_HIL_LEAVE, REQUEST_BODY(0u, 0u), request_hil_leave},
                                      REQUEST_ROWS_END};

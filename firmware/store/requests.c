#include "firmware/store/requests.h"

#include <stddef.h>

#include "firmware/store/actions.h"

static answer_status_t request_save(request_t* r) { return action_save(&r->answer); }

static answer_status_t request_load(request_t* r) { return action_load(&r->answer); }

static answer_status_t request_defaults(request_t* r) { return action_defaults(&r->answer); }

const request_row_t store_requests[] = {{REQUEST_OF_COMMAND(COMMAND_SAVE), ARGUMENT_BODY, request_save},
                                        {REQUEST_OF_COMMAND(COMMAND_DEFAULTS), ARGUMENT_BODY, request_defaults},
                                        {REQUEST_OF_COMMAND(COMMAND_LOAD), ARGUMENT_BODY, request_load},
                                        REQUEST_ROWS_END};

// What a user may ask of the store (api/actions.h).

#ifndef STILLSPIN_FIRMWARE_STORE_ACTIONS_H
#define STILLSPIN_FIRMWARE_STORE_ACTIONS_H

#include "firmware/api/actions.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Begin to keep the present parameters, and to take those that are kept; store_state tells what becomes of it.
answer_status_t action_save(octet_writer_t* why);
answer_status_t action_load(octet_writer_t* why);

/// Every parameter to its default; what is kept stays as it is.
answer_status_t action_defaults(octet_writer_t* why);

#if defined(__cplusplus)
}
#endif

#endif

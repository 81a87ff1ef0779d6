// What machines ask of the host in the loop.

#ifndef STILLSPIN_FIRMWARE_HIL_REQUESTS_H
#define STILLSPIN_FIRMWARE_HIL_REQUESTS_H

#include "firmware/link/request_rows.h"

#if defined(__cplusplus)
extern "C" {
#endif

extern const request_row_t hil_requests[];

#if defined(__cplusplus)
}
#endif

#endif

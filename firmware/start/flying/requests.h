// What machines ask of a look at the shaft.

#ifndef STILLSPIN_FIRMWARE_START_FLYING_REQUESTS_H
#define STILLSPIN_FIRMWARE_START_FLYING_REQUESTS_H

#include "firmware/link/request_rows.h"

#if defined(__cplusplus)
extern "C" {
#endif

extern const request_row_t look_requests[];

#if defined(__cplusplus)
}
#endif

#endif

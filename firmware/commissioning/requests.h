// What machines ask of the commissioning.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_REQUESTS_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_REQUESTS_H

#include "firmware/link/request_rows.h"

#if defined(__cplusplus)
extern "C" {
#endif

extern const request_row_t commissioning_requests[];

#if defined(__cplusplus)
}
#endif

#endif

// What machines ask of the parameter store.

#ifndef STILLSPIN_FIRMWARE_STORE_REQUESTS_H
#define STILLSPIN_FIRMWARE_STORE_REQUESTS_H

#include "firmware/link/request_rows.h"

#if defined(__cplusplus)
extern "C" {
#endif

extern const request_row_t store_requests[];

#if defined(__cplusplus)
}
#endif

#endif

// What machines ask of the scope.

#ifndef STILLSPIN_FIRMWARE_SCOPE_REQUESTS_H
#define STILLSPIN_FIRMWARE_SCOPE_REQUESTS_H

#include "firmware/link/request_rows.h"

#if defined(__cplusplus)
extern "C" {
#endif

extern const request_row_t scope_requests[];

#if defined(__cplusplus)
}
#endif

#endif

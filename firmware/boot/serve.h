// Going through a list of functions.

#ifndef STILLSPIN_FIRMWARE_BOOT_SERVE_H
#define STILLSPIN_FIRMWARE_BOOT_SERVE_H

#include "firmware/interfaces/service.h"

/// Calls them in their order.
void serve(service_t* const* services);

#endif

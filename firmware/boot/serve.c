// In a file of its own: called, it is shorter than a loop in the place of each call.

#include "firmware/boot/serve.h"

#include <stddef.h>

void serve(service_t* const* services) {
  for (; *services != NULL; services++) (*services)();
}

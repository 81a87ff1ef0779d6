#include "firmware/base/clear.h"

#include <stdint.h>

void clear(void* at, size_t count) {
  uint32_t* number = at;
  for (size_t left = count / sizeof *number; left > 0u; left--) *number++ = 0;
}

#include "firmware/base/clear.h"

#include <stdint.h>

void clear(void* at, size_t count) {
  uint32_t* const numbers = at;
  for (size_t k = 0; k < count / sizeof *numbers; k++) numbers[k] = 0;
}

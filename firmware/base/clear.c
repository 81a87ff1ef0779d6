#include "firmware/base/clear.h"

#include <stdint.h>

void clear(void* at, size_t count) {
  uint16_t* const words = at;
  for (size_t k = 0; k < count / sizeof *words; k++) words[k] = 0;
}

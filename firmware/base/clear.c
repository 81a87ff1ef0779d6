#include "firmware/base/clear.h"

void clear(void* at, size_t count) {
  unsigned char* const c = at;
  for (size_t k = 0; k < count; k++) c[k] = 0;
}

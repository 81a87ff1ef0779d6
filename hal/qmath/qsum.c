#include "hal/qmath/qsum.h"

#define END 4611686018427387903LL

void q_gather(int64_t* sum, int64_t x) {
  const int64_t before = (*sum > END) ? END : (*sum < -END) ? -END : *sum;
  *sum = before + x;
}

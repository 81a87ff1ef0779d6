#include "control/rise.h"

#include "hal/qmath/qcall.h"

int32_t rise_q30(int32_t x, int32_t from, int32_t to) {
  if (x <= from) return 0;
  const int32_t above = (int32_t)((uint32_t)x - (uint32_t)from);
  const int32_t apart = (int32_t)((uint32_t)to - (uint32_t)from);
  return q_clamp(qc_over(above, q_invert(apart), 30), 0, RISE_ONE_Q30);
}

#include "control/brake_limit.h"

#include "hal/qmath/qcall.h"

#define ONE_Q30 1073741824L

// Where x lies between from (0) and to (1), Q30.
static int32_t share_q30(int32_t x, int32_t from, int32_t to) {
  if (x <= from) return 0;
  return (x >= to) ? ONE_Q30 : qc_over(x - from, q_invert(to - from), 30);
}

int32_t brake_limit_q20(const brake_limit_input_t* in, int32_t limit_q20) {
  const int32_t full = share_q30(in->link_q16, in->start_q16, in->end_q16);
  const int32_t returns = share_q30(in->emf_q16, in->drop_q16 / 2, in->drop_q16);
  return q_mul(limit_q20, ONE_Q30 - q_mul(full, returns, 30), 30);
}

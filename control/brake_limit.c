#include "control/brake_limit.h"

#include "control/rise.h"
#include "hal/qmath/qcall.h"

int32_t brake_limit_q20(const brake_limit_input_t* in, int32_t limit_q20) {
  const int32_t full = rise_q30(in->link_q16, in->start_q16, in->end_q16);
  const int32_t returns = rise_q30(in->emf_q16, in->drop_q16 / 2, in->drop_q16);
  return qc_mul(limit_q20, RISE_ONE_Q30 - qc_mul(full, returns, 30), 30);
}

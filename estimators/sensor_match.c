#include "estimators/sensor_match.h"

#include "hal/qmath/qcall.h"

#define SQRT3_Q28 464943848L
#define MISMATCH_MAX_Q30 53687091L  // 5 %

void sensor_match_step(int32_t* mismatch_q30, const regression_t* r, q_inverse_t per_spread, q_inverse_t per_y0,
                       int32_t share_q30) {
  if (r->information <= 0) return;
  const int32_t across_q30 = qc_over(r->curl_q16, per_spread, 22);  // A per V and period
  const int32_t error_q30 = qc_mul_sat(qc_over(across_q30, per_y0, 30), SQRT3_Q28, 28);
  *mismatch_q30 =
      q_clamp(qc_add_sat(*mismatch_q30, q_mul(error_q30, share_q30, 30)), -MISMATCH_MAX_Q30, MISMATCH_MAX_Q30);
}

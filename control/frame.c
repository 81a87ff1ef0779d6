#include "control/frame.h"

#include "hal/qmath/qcall.h"

dq_t frame_turned(ab_t v, uint32_t angle_bam) { return frame_park(v, frame_rotation(angle_bam)); }

int32_t frame_largest(int32_t a, int32_t b) { return q_max(qc_abs_sat(a), qc_abs_sat(b)); }

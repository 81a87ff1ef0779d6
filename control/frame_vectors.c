// What the flux methods and hysteresis control want of frame.h: by itself, so that a drive without them goes without
// it.

#include "control/frame.h"

ab_t frame_fixed(dq_t w, uint32_t angle_bam) { return frame_inverse_park(w, frame_rotation(angle_bam)); }

int32_t frame_dot_q24(ab_t a, ab_t b) { return q_mul_add_sat(a.alpha, b.alpha, a.beta, b.beta, 24); }

int32_t frame_cross_q24(ab_t a, ab_t b) { return q_mul_sub_sat(a.alpha, b.beta, a.beta, b.alpha, 24); }

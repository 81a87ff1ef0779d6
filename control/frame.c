#include "control/frame.h"

dq_t frame_turned(ab_t v, uint32_t angle_bam) { return frame_park(v, frame_rotation(angle_bam)); }

// Sine, cosine and the angle of a vector in binary angles (one turn = 2^32).
//
// Sine and cosine: 64 nodes in a quarter turn and the angle sum from the nearest one, to third order. Worst error
// 1.8e-9, under 2 LSB of Q30 (every third angle of a quarter turn tried); exact on the axes.
// Cost: 58 instructions (42 on a Cortex-M3) for both together. Table: 130 words.
//
// Arctangent: the ratio of the shorter to the longer side by reciprocal, and a minimax polynomial of degree 17. Worst
// error 5.9 LSB = 1.4e-9 turn = 8.6e-9 rad; exact on the axes and diagonals. Cost: 134 instructions.

#ifndef STILLSPIN_HAL_QMATH_QTRIG_H
#define STILLSPIN_HAL_QMATH_QTRIG_H

#include <stdint.h>

#include "hal/qmath/qangle.h"

#if defined(__cplusplus)
extern "C" {
#endif

// Sine and cosine of an angle in Q30, -2^30 .. +2^30.
void q_sincos(angle_bam32_t angle_bam, int32_t* sin_q30, int32_t* cos_q30);

// Angle of the vector (x, y) from the x axis. Only the ratio counts: x and y may be of any size and any common Q
// format. (0, 0) gives 0.
angle_bam32_t q_atan2(int32_t y, int32_t x);

#if defined(__cplusplus)
}
#endif

#endif

// Binary angles: one turn is 2^32, so that angles wrap where the word wraps and need no range reduction.
//
// Names end in _bam. A difference of angles and an angle per time are signed: int32_t, -1/2 turn .. +1/2 turn.

#ifndef STILLSPIN_HAL_QMATH_QANGLE_H
#define STILLSPIN_HAL_QMATH_QANGLE_H

#include <stdint.h>

#include "hal/qmath/qarith.h"

typedef uint32_t angle_bam32_t;

#define ANGLE_BAM_EIGHTH_TURN ((angle_bam32_t)0x20000000uL)
#define ANGLE_BAM_QUARTER_TURN ((angle_bam32_t)0x40000000uL)
#define ANGLE_BAM_HALF_TURN ((angle_bam32_t)0x80000000uL)

// Binary angle of a radian, 2^32 / 2 pi.
#define ANGLE_BAM_PER_RAD 683565276L

// A whole number of degrees as a binary angle, within 1 LSB, for |degrees| < 6e7; 2^32 / 360 = 11930464 + 32 / 45.
// A constant expression where its argument is one.
#define ANGLE_BAM_DEGREES(degrees) \
  ((angle_bam32_t)((uint32_t)(int32_t)(degrees) * 11930464uL + (uint32_t)((int32_t)(degrees) * 32L / 45L)))

// 2 pi / 16 in Q32 and its inverse in Q29: between binary angles and radians in Q28 (|angle| < 8 rad).
#define ANGLE_RAD_Q28_PER_BAM_Q32 1686629713L
#define ANGLE_BAM_PER_RAD_Q28_Q29 1367130551L

// The shortest way from b to a, -1/2 turn .. +1/2 turn (exactly half a turn is negative).
static inline int32_t angle_diff_bam(angle_bam32_t a, angle_bam32_t b) { return (int32_t)(a - b); }

// a moved by a signed angle.
static inline angle_bam32_t angle_add_bam(angle_bam32_t a, int32_t delta_bam) { return a + (uint32_t)delta_bam; }

// The electrical angle of a mechanical one: pole_pairs turns for one.
static inline angle_bam32_t angle_times(angle_bam32_t a, uint16_t pole_pairs) { return a * (uint32_t)pole_pairs; }

// Turns to binary angle; whole turns fall away.
static inline angle_bam32_t angle_from_turn_q15(int32_t turn_q15) { return (uint32_t)turn_q15 << 17; }

static inline angle_bam32_t angle_from_turn_q30(int32_t turn_q30) { return (uint32_t)turn_q30 << 2; }

// Binary angle to turns, -0.5 .. +0.5 (rounded: +0.5 is possible).
static inline int32_t angle_to_turn_q15(angle_bam32_t a) { return q_shr_round((int32_t)a, 17); }

static inline int32_t angle_to_turn_q30(angle_bam32_t a) { return q_shr_round((int32_t)a, 2); }

// Radians in Q28 (-8 .. +8 rad) to binary angle, within 2 LSB; whole turns fall away.
static inline angle_bam32_t angle_from_rad_q28(int32_t rad_q28) {
  return (angle_bam32_t)q_mul64(rad_q28, ANGLE_BAM_PER_RAD_Q28_Q29, 29);
}

// A signed binary angle to radians in Q28, -pi .. +pi, within 1 LSB.
static inline int32_t angle_bam_to_rad_q28(int32_t angle_bam) {
  return q_mul(angle_bam, ANGLE_RAD_Q28_PER_BAM_Q32, 32);
}

#endif

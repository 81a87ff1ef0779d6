#include "hal/qmath/qtrig.h"

#include "hal/qmath/qarith.h"
#include "hal/qmath/qdiv.h"

#define QUADRANT_BITS 30  // a quarter turn is 2^30
#define SEGMENT_BITS 24   // of 64 segments of 2^24
#define SEGMENTS (1uL << (QUADRANT_BITS - SEGMENT_BITS))
// pi / 8 in Q32: from 2^-8 of a binary angle's LSB to radians in Q36, by the upper word of the product.
#define RAD_Q36_PER_BAM_Q8 1686629713L
#define ONE_SIXTH_Q32 715827883L

// sin(i * 90 deg / 64) in Q30.
static const int32_t quarter_sine_q30[65] = {
    0L,          26350943L,   52686014L,   78989349L,   105245103L,  131437462L,  157550647L,  183568930L,  209476638L,
    235258165L,  260897982L,  286380643L,  311690799L,  336813204L,  361732726L,  386434353L,  410903207L,  435124548L,
    459083786L,  482766489L,  506158392L,  529245404L,  552013618L,  574449320L,  596538995L,  618269338L,  639627258L,
    660599890L,  681174602L,  701339000L,  721080937L,  740388522L,  759250125L,  777654384L,  795590213L,  813046808L,
    830013654L,  846480531L,  862437520L,  877875009L,  892783698L,  907154608L,  920979082L,  934248793L,  946955747L,
    959092290L,  970651112L,  981625251L,  992008094L,  1001793390L, 1010975242L, 1019548121L, 1027506862L, 1034846671L,
    1041563127L, 1047652185L, 1053110176L, 1057933813L, 1062120190L, 1065666786L, 1068571464L, 1070832474L, 1072448455L,
    1073418433L, 1073741824L,
};

// Sine and cosine of 0..1/4 turn.
static void sincos_of_quadrant(uint32_t phase, int32_t* sin_q30, int32_t* cos_q30) {
  // Nearest node a and the distance d to it: sin(a + d) = sin a cos d + cos a sin d with cos d = 1 - d^2/2 and
  // sin d = d - d^3/6; |d| <= 2^-7 pi / 2 = 0.0123, so that the neglected d^4/24 is about one LSB.
  const uint32_t node = (phase + ((uint32_t)1 << (SEGMENT_BITS - 1))) >> SEGMENT_BITS;
  const int32_t distance_bam = (int32_t)(phase - (node << SEGMENT_BITS));
  const int32_t d_q36 = q_mul_hi(distance_bam * 256, RAD_Q36_PER_BAM_Q8);
  const int32_t square_q40 = q_mul_hi(d_q36, d_q36);
  const int32_t cube_q44 = q_mul_hi(d_q36, square_q40);
  const int32_t sin_d_q36 = d_q36 - q_shr(q_mul_hi(cube_q44, ONE_SIXTH_Q32), 8);
  const int32_t sin_a_q30 = quarter_sine_q30[node];
  const int32_t cos_a_q30 = quarter_sine_q30[SEGMENTS - node];
  // d^2 in Q40 is d^2/2 in Q41.
  const int32_t sin_step_q34 = q_mul_hi(cos_a_q30, sin_d_q36) - q_shr(q_mul_hi(sin_a_q30, square_q40), 5);
  const int32_t cos_step_q34 = -q_mul_hi(sin_a_q30, sin_d_q36) - q_shr(q_mul_hi(cos_a_q30, square_q40), 5);
  *sin_q30 = sin_a_q30 + q_shr(sin_step_q34 + 8, 4);
  *cos_q30 = cos_a_q30 + q_shr(cos_step_q34 + 8, 4);
}

void q_sincos(angle_bam32_t angle_bam, int32_t* sin_q30, int32_t* cos_q30) {
  int32_t sine;
  int32_t cosine;
  sincos_of_quadrant(angle_bam & (ANGLE_BAM_QUARTER_TURN - 1), &sine, &cosine);
  if ((angle_bam & ANGLE_BAM_QUARTER_TURN) != 0) {
    const int32_t swap = sine;
    sine = cosine;
    cosine = -swap;
  }
  if ((angle_bam & ANGLE_BAM_HALF_TURN) != 0) {
    sine = -sine;
    cosine = -cosine;
  }
  *sin_q30 = sine;
  *cos_q30 = cosine;
}

// Binary angle of t = tan(angle) in Q31, 0..1: t (1/8 + (1 - t^2) p(t^2)) turns, exact at 0 and at 1/8 turn.
// p is the minimax polynomial of this form of lowest absolute error (Remez).
static uint32_t arctangent(uint32_t t_q31) {
  const int32_t u_q31 = (int32_t)(((uint64_t)t_q31 * t_q31) >> 31);
  // Horner from the highest power; each product with u in Q31 takes one bit from the Q format.
  int32_t p = -422311978L;               // Q40
  p = q_mul_hi(p, u_q31) + 1033810582L;  // Q39
  p = q_mul_hi(p, u_q31) - 1211158625L;  // Q38
  p = q_mul_hi(p, u_q31) + 971703253L;   // Q37
  p = q_mul_hi(p, u_q31) - 661142237L;   // Q36
  p = q_mul_hi(p, u_q31) + 443664106L;   // Q35
  p = q_mul_hi(p, u_q31) - 324622312L;   // Q34
  p = q_mul_hi(p, u_q31) + 293388565L;   // Q33
  const uint32_t per_t_q32 = ANGLE_BAM_EIGHTH_TURN + (uint32_t)q_mul_hi(p, (int32_t)(0x7FFFFFFFuL - (uint32_t)u_q31));
  return (uint32_t)(((uint64_t)t_q31 * per_t_q32 + ((uint32_t)1 << 30)) >> 31);
}

angle_bam32_t q_atan2(int32_t y, int32_t x) {
  const uint32_t x_size = q_abs_u32(x);
  const uint32_t y_size = q_abs_u32(y);
  const bool steep = y_size > x_size;
  const uint32_t longer = (y_size > x_size) ? y_size : x_size;
  const uint32_t shorter = (y_size > x_size) ? x_size : y_size;
  const unsigned zeros = q_clz32(longer);
  angle_bam32_t angle;
  if (longer == 0) {
    return 0;
  }
  angle = arctangent(q_umul_hi(shorter << zeros, q_reciprocal_q31(longer << zeros)));
  if (steep) {
    angle = ANGLE_BAM_QUARTER_TURN - angle;
  }
  if (x < 0) {
    angle = ANGLE_BAM_HALF_TURN - angle;
  }
  return (y < 0) ? (0 - angle) : angle;
}

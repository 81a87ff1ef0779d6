// Reference frames: three phases, the stationary alpha-beta frame and a rotating d-q frame.
//
// Clarke is amplitude invariant (peak values) and takes a + b + c = 0; alpha lies on phase a. Park turns by the
// electrical angle, d-axis ahead. A vector keeps the Q format of its components. Valid below half of the 32-bit range:
// no saturation.
//
// A slope measured in alpha-beta and turned by Park is *not* the derivative of the d-q current: the two differ by
// omega J i (see docs, "Physics").

#ifndef STILLSPIN_CONTROL_FRAME_H
#define STILLSPIN_CONTROL_FRAME_H

#include "hal/qmath/qmath.h"

typedef struct {
  int32_t alpha, beta;
} ab_t;

typedef struct {
  int32_t d, q;
} dq_t;

typedef struct {
  int32_t a, b, c;
} abc_t;

/// Sine and cosine of one electrical angle, Q30.
typedef struct {
  int32_t sin_q30, cos_q30;
} rotation_t;

#define FRAME_SQRT3_INV_Q30 619925131L   // 1/sqrt(3)
#define FRAME_SQRT3_HALF_Q30 929887697L  // sqrt(3)/2
#define FRAME_SQRT3_HALF_Q31 1859775393L

static inline rotation_t frame_rotation(uint32_t angle_bam) {
  rotation_t r;
  q_sincos(angle_bam, &r.sin_q30, &r.cos_q30);
  return r;
}

/// Two measured phases of a star-connected machine (a + b + c = 0).
static inline ab_t frame_clarke2(int32_t a, int32_t b) {
  ab_t v = {a, q_mul_floor(a + 2 * b, FRAME_SQRT3_INV_Q30, 30)};
  return v;
}

/// Three phase quantities with any common part, e.g. leg voltages.
static inline ab_t frame_clarke3(abc_t x) {
  ab_t v = {(2 * x.a - x.b - x.c) / 3, q_mul_floor(x.b - x.c, FRAME_SQRT3_INV_Q30, 30)};
  return v;
}

static inline dq_t frame_park(ab_t v, rotation_t r) {
  dq_t w = {q_mul_add_floor(v.alpha, r.cos_q30, v.beta, r.sin_q30, 30),
            q_mul_add_floor(v.beta, r.cos_q30, -v.alpha, r.sin_q30, 30)};
  return w;
}

/// The same by upper words, for a vector in which two bits more than wanted stand: components two bits coarser.
static inline dq_t frame_park_hi(ab_t v, rotation_t r) {
  const dq_t w = {q_mul_hi(v.alpha, r.cos_q30) + q_mul_hi(v.beta, r.sin_q30),
                  q_mul_hi(v.beta, r.cos_q30) - q_mul_hi(v.alpha, r.sin_q30)};
  return w;
}

static inline ab_t frame_inverse_park(dq_t w, rotation_t r) {
  ab_t v = {q_mul_add_floor(w.d, r.cos_q30, -w.q, r.sin_q30, 30), q_mul_add_floor(w.d, r.sin_q30, w.q, r.cos_q30, 30)};
  return v;
}

/// By upper words alone, a few LSB less exact: where a product's last bits do not count, a third of the work on a
/// machine without 64-bit registers.
static inline abc_t frame_inverse_clarke(ab_t v) {
  const int32_t half = q_shr(v.alpha, 1);
  const int32_t side = 2 * q_mul_hi(v.beta, FRAME_SQRT3_HALF_Q31);
  abc_t x = {v.alpha, side - half, -side - half};
  return x;
}

/// The inverse of Park's, by upper words as well.
static inline ab_t frame_back(dq_t w, rotation_t r) {
  ab_t v = {4 * (q_mul_hi(w.d, r.cos_q30) - q_mul_hi(w.q, r.sin_q30)),
            4 * (q_mul_hi(w.d, r.sin_q30) + q_mul_hi(w.q, r.cos_q30))};
  return v;
}

/// The larger magnitude of two components.
int32_t frame_largest(int32_t a, int32_t b);

/// A vector of the stationary frame in one at this angle, and back.
dq_t frame_turned(ab_t v, uint32_t angle_bam);
ab_t frame_fixed(dq_t w, uint32_t angle_bam);

/// A vector of a frame in another one that is ahead of it.
static inline dq_t frame_moved(dq_t w, uint32_t ahead_bam) {
  const ab_t own = {w.d, w.q};
  return frame_turned(own, ahead_bam);
}

/// a . b and a cross b of vectors in Q24.
int32_t frame_dot_q24(ab_t a, ab_t b);
int32_t frame_cross_q24(ab_t a, ab_t b);

#endif

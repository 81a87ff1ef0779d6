#include "hal/qmath/qsqrt.h"

#include "hal/qmath/qarith.h"
#include "hal/qmath/qdiv.h"

// 1/sqrt(M) in Q15 at the ends of 12 equal intervals of M in [0.25, 1), lowered by half of what a chord is too high.
static const uint16_t inverse_roots_q15[13] = {65383u, 58480u, 53426u, 49485u, 46302u, 43662u, 41427u,
                                               39503u, 37824u, 36342u, 35021u, 33835u, 32762u};

// First guess of 1/sqrt(M) in Q15, along a chord: within 0.28 %.
static uint32_t guess_q15(uint32_t m_q32) {
  const uint16_t* const ends = &inverse_roots_q15[(uint16_t)(m_q32 >> 28) - 4u];
  const uint32_t within_q8 = (m_q32 >> 20) & 255u;
  return ends[0] - (((uint32_t)(ends[0] - ends[1]) * within_q8) >> 8);
}

// 1/sqrt(M) in Q30, too small by at most 2^-25, for M in [0.25, 1) given in Q32.
static uint32_t inverse_root_q30(uint32_t m_q32) {
  // Newton: R <- R (3 - M R^2) / 2, from 8 bits to 16 to 32. The subtracted LSBs keep the estimate below.
  const uint32_t seed_q15 = guess_q15(m_q32);
  const uint32_t step1_q30 = 0xC0000000uL - 3 - q_umul_hi(m_q32, seed_q15 * seed_q15);
  const uint32_t root_q30 = (uint32_t)(((uint64_t)seed_q15 * step1_q30) >> 16);
  const uint32_t square_q29 = (uint32_t)(((uint64_t)root_q30 * root_q30) >> 31);
  const uint32_t step2_q29 = 0x60000000uL - 3 - q_umul_hi(m_q32, square_q29);
  return (uint32_t)(((uint64_t)root_q30 * step2_q29) >> 30);
}

// floor(sqrt(x)) for x in [2^62, 2^64); *rest is x less the square of it, 0..2 sqrt(x).
static uint32_t root_normalised(uint64_t x, uint64_t* rest) {
  const uint32_t upper = (uint32_t)(x >> 32);
  const uint32_t inverse_q30 = inverse_root_q30(upper);
  uint32_t root = (uint32_t)(((uint64_t)upper * inverse_q30) >> 30);  // sqrt(M) = M / sqrt(M), 25 bits
  uint64_t left = x - (uint64_t)root * root;                          // below 2^38
  root += (uint32_t)(((left >> 9) * inverse_q30) >> 54);              // + left / (2 sqrt(x))
  left = x - (uint64_t)root * root;
  if (left > 2 * (uint64_t)root) {
    left -= 2 * (uint64_t)root + 1;
    root++;
  }
  *rest = left;
  return root;
}

uint32_t q_sqrt64(uint64_t x) {
  const uint32_t upper = (uint32_t)(x >> 32);
  const unsigned zeros = (upper != 0) ? q_clz32(upper) : 32 + q_clz32((uint32_t)x);
  const unsigned half_shift = zeros / 2;
  uint64_t rest;
  uint32_t root;
  if (x == 0) {
    return 0;
  }
  root = root_normalised(x << (2 * half_shift), &rest);
  if (half_shift != 0) {
    return (root >> half_shift) + ((root >> (half_shift - 1)) & 1);
  }
  return root + ((rest > root && root != UINT32_MAX) ? 1 : 0);
}

uint32_t q_sqrt32(uint32_t x) { return q_sqrt64(x); }

int32_t q_hypot(int32_t a, int32_t b) {
  const uint32_t a_size = q_abs_u32(a);
  const uint32_t b_size = q_abs_u32(b);
  const uint32_t length = q_sqrt64((uint64_t)a_size * a_size + (uint64_t)b_size * b_size);
  return (length > INT32_MAX) ? INT32_MAX : (int32_t)length;
}

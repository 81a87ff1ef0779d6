#include "hal/qmath/qsqrt.h"

#include "hal/qmath/qarith.h"
#include "hal/qmath/qdiv.h"

// First guess of 1/sqrt(M) in Q15: round(2^15 / sqrt(M)) at the middle of each of 96 equal intervals of M in [0.25, 1).
static const uint16_t inverse_root_seed_q15[96] = {
    65030u, 64052u, 63117u, 62222u, 61363u, 60540u, 59748u, 58987u, 58254u, 57548u, 56867u, 56210u, 55574u, 54960u,
    54366u, 53791u, 53233u, 52693u, 52169u, 51660u, 51165u, 50685u, 50218u, 49763u, 49321u, 48890u, 48470u, 48061u,
    47663u, 47273u, 46894u, 46523u, 46161u, 45807u, 45462u, 45124u, 44793u, 44470u, 44153u, 43843u, 43540u, 43243u,
    42951u, 42666u, 42386u, 42112u, 41843u, 41579u, 41320u, 41065u, 40816u, 40571u, 40330u, 40093u, 39861u, 39632u,
    39408u, 39187u, 38970u, 38756u, 38546u, 38340u, 38136u, 37936u, 37739u, 37545u, 37354u, 37166u, 36980u, 36798u,
    36618u, 36441u, 36266u, 36093u, 35924u, 35756u, 35591u, 35428u, 35267u, 35109u, 34953u, 34798u, 34646u, 34496u,
    34347u, 34201u, 34056u, 33913u, 33772u, 33633u, 33496u, 33360u, 33225u, 33093u, 32962u, 32832u,
};

// 1/sqrt(M) in Q30, too small by at most 2^-25, for M in [0.25, 1) given in Q32.
static uint32_t inverse_root_q30(uint32_t m_q32) {
  // Newton: R <- R (3 - M R^2) / 2, from 7 bits to 13 to 26. The subtracted LSBs keep the estimate below.
  const uint32_t seed_q15 = inverse_root_seed_q15[(m_q32 >> 25) - 32];
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

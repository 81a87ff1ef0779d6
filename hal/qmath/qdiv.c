#include "hal/qmath/qdiv.h"

#include "hal/qmath/qarith.h"

// First guess of 1/D in Q15: round(2^15 / D) at the middle of each of 128 equal intervals of D in [0.5, 1).
static const uint16_t reciprocal_seed_q15[128] = {
    65281u, 64777u, 64281u, 63792u, 63310u, 62836u, 62369u, 61909u, 61455u, 61008u, 60568u, 60133u, 59705u,
    59283u, 58867u, 58457u, 58053u, 57654u, 57260u, 56872u, 56489u, 56111u, 55738u, 55370u, 55007u, 54649u,
    54295u, 53946u, 53601u, 53261u, 52925u, 52593u, 52265u, 51942u, 51622u, 51306u, 50995u, 50686u, 50382u,
    50081u, 49784u, 49490u, 49200u, 48913u, 48630u, 48349u, 48072u, 47798u, 47528u, 47260u, 46995u, 46733u,
    46474u, 46218u, 45965u, 45714u, 45467u, 45222u, 44979u, 44739u, 44502u, 44267u, 44035u, 43805u, 43577u,
    43352u, 43129u, 42908u, 42690u, 42474u, 42260u, 42048u, 41838u, 41631u, 41425u, 41222u, 41020u, 40820u,
    40623u, 40427u, 40233u, 40041u, 39851u, 39662u, 39476u, 39291u, 39108u, 38926u, 38746u, 38568u, 38392u,
    38217u, 38044u, 37872u, 37702u, 37533u, 37366u, 37200u, 37036u, 36873u, 36712u, 36552u, 36393u, 36236u,
    36080u, 35926u, 35772u, 35620u, 35470u, 35320u, 35172u, 35026u, 34880u, 34735u, 34592u, 34450u, 34309u,
    34169u, 34031u, 33893u, 33757u, 33622u, 33487u, 33354u, 33222u, 33091u, 32961u, 32832u,
};

unsigned q_clz32(uint32_t x) {
  static const uint16_t zeros_of_nibble[16] = {4u, 3u, 2u, 2u, 1u, 1u, 1u, 1u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u};
  unsigned zeros = 0;
  if (x < 0x10000uL) {
    zeros += 16;
    x <<= 16;
  }
  if (x < 0x1000000uL) {
    zeros += 8;
    x <<= 8;
  }
  if (x < 0x10000000uL) {
    zeros += 4;
    x <<= 4;
  }
  return zeros + zeros_of_nibble[x >> 28];
}

uint32_t q_reciprocal_q31(uint32_t divisor) {
  // 8 bits -> 16 bits: R (2 - D R), with ~x for 2 - x so that rounding, too, keeps the estimate below.
  const uint32_t seed_q31 = (uint32_t)reciprocal_seed_q15[(divisor >> 24) - 128] << 16;
  const uint32_t estimate_q31 = (uint32_t)(((uint64_t)seed_q31 * ~q_umul_hi(divisor, seed_q31)) >> 31);
  // 16 bits -> 31 bits: R + R (1 - D R). The rest 1 - D R is below 2^-15, so its upper 32 bits say enough.
  const uint64_t rest_q63 = ((uint64_t)1 << 63) - (uint64_t)divisor * estimate_q31;
  const uint32_t rest_q47 = (uint32_t)(rest_q63 >> 16);
  return estimate_q31 + (uint32_t)(((uint64_t)estimate_q31 * rest_q47) >> 47);
}

q_inverse_t q_invert(int32_t divisor) {
  const uint32_t positive = (divisor > 0) ? (uint32_t)divisor : 1u;
  const unsigned zeros = q_clz32(positive);
  const q_inverse_t inverse = {(int32_t)(q_reciprocal_q31(positive << zeros) >> 1), 62u - zeros};
  return inverse;
}

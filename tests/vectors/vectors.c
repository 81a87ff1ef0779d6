#include "tests/vectors/vectors.h"

#include "control/frame.h"
#include "estimators/blend.h"
#include "estimators/tracking_observer.h"
#include "hal/qmath/qmath.h"

#define BLOCKS 8u
#define CASES 64u  // in a block
#define FNV_PRIME 16777619uL
#define FNV_BASIS 2166136261uL

static uint32_t state;
static uint32_t hash;

// xorshift32 (G. Marsaglia, "Xorshift RNGs", J. Statistical Software 8(14), 2003).
static uint32_t draw(void) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

static uint32_t below(uint32_t count) { return (draw() >> 8) % count; }

// Of every size, every eighth an edge.
static int32_t number(void) {
  static const int32_t edges[] = {0L,          1L,          -1L,       2L,          -2L,     32767L,
                                  -32768L,     32768L,      65535L,    65536L,      -65536L, 1073741824L,
                                  2147483646L, 2147483647L, INT32_MIN, -2147483647L};
  const uint32_t kind = draw();
  if ((kind & 7u) == 0u) return edges[below(16)];
  const uint32_t shift = below(32);
  const uint32_t size = draw() >> shift;
  return (int32_t)(((kind & 8u) != 0u) ? 0u - size : size);
}

static void result(uint32_t word) { hash = (hash ^ word) * FNV_PRIME; }
static void signed_result(int32_t value) { result((uint32_t)value); }

static void sums(void) {
  const int32_t a = number(), b = number();
  signed_result(q_add_sat(a, b));
  signed_result(q_sub_sat(a, b));
  signed_result(q_neg_sat(a));
  signed_result(q_abs_sat(a));
  result(q_abs_u32(b));
}

static void shifts(void) {
  const int32_t a = number();
  const unsigned n = (unsigned)below(32);
  signed_result(q_shl_sat(a, (n < 31u) ? n : 0u));
  signed_result(q_shr(a, n));
  signed_result(q_shr_round(a, n));
  result(q_clz32((uint32_t)a));
}

static void products(void) {
  const int32_t a = number(), b = number();
  const unsigned shift = 1u + (unsigned)below(62);
  signed_result(q_mul_sat(a, b, shift));
  signed_result(q_mul_hi(a, b));
  result(q_umul_hi((uint32_t)a, (uint32_t)b));
}

static void sums_of_products(void) {
  const int32_t a = q_shr(number(), 2), b = number(), c = q_shr(number(), 2), d = number();
  const unsigned shift = 1u + (unsigned)below(62);
  signed_result(q_mul_add_sat(a, b, c, d, shift));
  signed_result(q_mul_sub_sat(a, b, c, d, shift));
}

static int16_t half(int32_t a) { return (int16_t)q_clamp(q_shr(a, 8), INT16_MIN, INT16_MAX); }

static void halves(void) {
  const int16_t a = half(number()), b = half(number());
  signed_result(q15_add_sat(a, b));
  signed_result(q15_sub_sat(a, b));
  signed_result(q15_mul(a, b));
}

static void quotients(void) {
  const int32_t num = number(), den = number();
  signed_result(q_div(num, den, (unsigned)below(32)));
  result(q_reciprocal_q31((uint32_t)den | 0x80000000uL));
  signed_result(q_over(num, q_invert(den), (unsigned)below(31)));
  // A quotient of 31 bits, whose rounding takes the remainder.
  const unsigned most = 31u + q_clz32(q_abs_u32(num)) - q_clz32(q_abs_u32(den));
  signed_result((most < 32u) ? q_div(num, den, most) : 0);
}

static void roots(void) {
  const uint32_t upper = (uint32_t)number(), lower = (uint32_t)number();
  result(q_sqrt64((uint64_t)upper << 32 | lower));
  result(q_sqrt32(lower));
  signed_result(q_hypot((int32_t)upper, (int32_t)lower));
  const uint64_t square = (uint64_t)lower * lower;
  result(q_sqrt64(square));
  result(q_sqrt64(square + lower));
  result(q_sqrt64(square + lower + 1u));
}

static void angles(void) {
  int32_t sine, cosine;
  q_sincos((uint32_t)number(), &sine, &cosine);
  signed_result(sine);
  signed_result(cosine);
  const int32_t y = number(), x = number();
  result(q_atan2(y, x));
}

static void frames(void) {
  const int32_t a = q_shr(number(), 3), b = q_shr(number(), 3);
  const ab_t v = frame_clarke2(a, b);
  const rotation_t turn = frame_rotation((uint32_t)number());
  const dq_t w = frame_park(v, turn);
  const ab_t back = frame_inverse_park(w, turn);
  const abc_t legs = frame_inverse_clarke(back);
  signed_result(w.d);
  signed_result(w.q);
  signed_result(legs.a);
  signed_result(legs.b);
  signed_result(legs.c);
}

static tracking_observer_t tracking;

static void tracking_observer(void) {
  tracking_observer_predict(&tracking, q_shr(number(), 4));
  const int32_t error = number(), bandwidth = (int32_t)(draw() >> 8);
  tracking_observer_correct(&tracking, error, bandwidth);
  result(tracking.angle_bam);
  signed_result(tracking.speed_bpp);
  signed_result(tracking.load_accel_q8);
  signed_result(tracking.speed_remainder_q8);
}

static blend_t blending;

static estimator_output_t output(void) {
  estimator_output_t e;
  e.angle_bam = (uint32_t)number();
  e.speed_bpp = q_shr(number(), 8);
  e.load_accel_q8 = q_shr(number(), 3);
  e.quality_q15 = (int32_t)below(32768);
  return e;
}

static void blend(void) {
  blend_config_t c;
  const int32_t low_end = 1 + (int32_t)below(1000000), high_end = 1000001L + (int32_t)below(9000000);
  if (!blend_design(&c, low_end, high_end)) return;
  const estimator_output_t low = output(), high = output();
  const estimator_output_t out = blend_step(&blending, &c, &low, &high);
  result(out.angle_bam);
  signed_result(out.speed_bpp);
  signed_result(out.load_accel_q8);
  signed_result(out.quality_q15);
  signed_result(blending.share_q15);
}

static const struct {
  const char* name;
  void (*one_case)(void);
} groups[] = {{"sums", sums},         {"shifts", shifts},
              {"products", products}, {"sums_of_products", sums_of_products},
              {"halves", halves},     {"quotients", quotients},
              {"roots", roots},       {"angles", angles},
              {"frames", frames},     {"tracking_observer", tracking_observer},
              {"blend", blend}};

static void put_line(const char* name, unsigned block) {
  while (*name != '\0') put_char(*name++);
  put_char(' ');
  put_char((char)('0' + block));
  put_char(' ');
  for (unsigned k = 0; k < 8u; k++) put_char("0123456789abcdef"[hash >> (28u - 4u * k) & 15u]);
  put_char('\n');
}

void run_vectors(void) {
  tracking_observer_preset(&tracking, 0, 0, 0);
  blend_reset(&blending);
  for (unsigned g = 0; g < sizeof groups / sizeof groups[0]; g++) {
    state = 2463534242uL + g;
    for (unsigned block = 0; block < BLOCKS; block++) {
      hash = FNV_BASIS;
      for (unsigned k = 0; k < CASES; k++) groups[g].one_case();
      put_line(groups[g].name, block);
    }
  }
}

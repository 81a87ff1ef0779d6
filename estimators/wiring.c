#include "estimators/wiring.h"

#include "hal/qmath/qcall.h"

#define ONE_Q30 1073741824L
#define HALF_SQRT3_Q30 929887697L
#define PARTS 8     // less than so many parts of what the other one has is nothing
#define SALIENCY 8  // (Lq - Ld)/(Lq + Ld) is below 7/8: Lq below fifteen times Ld
#define FAINT 32    // so many parts of what the nameplate lets expect are no current
#define CLEAR 32    // so many times what the converter's steps may fake is judged

// What a sensor sees of the voltage: per volt along the axis of phase a, and across it.
typedef struct {
  int32_t x, y;
} sight_t;

static int32_t size_of(sight_t g) { return q_hypot(g.x, g.y); }

// Nearest multiple of a sixth of a turn, 0..5.
static uint16_t sixth_of(sight_t g) {
  const uint32_t angle = (uint32_t)q_atan2(g.y, g.x) + 0xFFFFFFFFuL / 12u;
  return (uint16_t)(((angle >> 16) * 6u) >> 16);
}

// With a phase open the current has the line across its axis alone, and so has what the other sensor sees.
static bool is_across(sight_t g, int32_t cosine_q30, int32_t sine_q30) {
  return qc_abs_sat(q_mul_add_sat(g.x, cosine_q30, g.y, sine_q30, 30)) < size_of(g) / PARTS;
}

static wiring_t by_order(uint16_t a, uint16_t b) {
  if (a == 0u && b == 2u) return WIRING_GOOD;
  if (a == 3u && b == 2u) return WIRING_REVERSED_A;
  if (a == 0u && b == 5u) return WIRING_REVERSED_B;
  if (a == 3u && b == 5u) return WIRING_REVERSED_BOTH;
  return (a == 2u && b == 0u) ? WIRING_SWAPPED : WIRING_OTHER_PHASES;
}

static wiring_t name_of(sight_t a, sight_t b) {
  const int32_t size_a = size_of(a), size_b = size_of(b);
  const sight_t c = {qc_add_sat(a.x, b.x), qc_add_sat(a.y, b.y)};
  if (size_a < size_b / PARTS) return is_across(b, ONE_Q30, 0) ? WIRING_OPEN_A : WIRING_DEAD_A;
  if (size_b < size_a / PARTS) return is_across(a, -ONE_Q30 / 2, HALF_SQRT3_Q30) ? WIRING_OPEN_B : WIRING_DEAD_B;
  if (size_of(c) < size_a / PARTS) return WIRING_OPEN_C;
  return by_order(sixth_of(a), sixth_of(b));
}

// What a code of error in a quarter of the windows would look like.
static int32_t floor_of(const axis_t* s, int32_t code_q20) {
  const uint32_t volts_q4 = q_sqrt64((uint64_t)q_product(q_max(s->spread_q8, 0), s->count));
  return qc_mul_sat(code_q20, (int32_t)volts_q4, 10);
}

static bool is_full(int32_t sum) { return qc_abs_sat(sum) == INT32_MAX; }

// Sums in a quarter of their size: twice of one, and four of them, have room.
wiring_t wiring_judge(const axis_t* s, const machine_model_t* m, int32_t code_q20) {
  const int32_t expected_q14 = qc_mul_sat(m->yd_q30 / 2 + m->yq_q30 / 2, s->spread_q8, 24);
  const int32_t saliency_q14 = qc_mul_sat((m->yd_q30 - m->yq_q30) / 2, s->spread_q8, 24);
  const int32_t y = qc_add_sat(expected_q14, q_shr(s->along_q16, 2));
  const int32_t x = qc_add_sat(saliency_q14, q_shr(s->mirror_q16, 2));
  const int32_t c = q_shr(s->cross_q16, 2), u = q_shr(s->curl_q16, 2);
  if (is_full(s->along_q16) || is_full(s->mirror_q16) || is_full(s->cross_q16) || is_full(y)) return WIRING_GOOD;
  if (y > expected_q14 / FAINT && qc_abs_sat(u) < y / 4 && q_hypot(x, c) < y / SALIENCY * (SALIENCY - 1))
    return WIRING_GOOD;
  const sight_t a = {qc_add_sat(y, x), qc_sub_sat(c, u)};
  const sight_t beta = {qc_add_sat(c, u), qc_sub_sat(y, x)};
  const sight_t b = {q_mul_sub_sat(beta.x, HALF_SQRT3_Q30, a.x, ONE_Q30 / 2, 30),
                     q_mul_sub_sat(beta.y, HALF_SQRT3_Q30, a.y, ONE_Q30 / 2, 30)};
  const int32_t floor_q14 = floor_of(s, code_q20);
  const int32_t size = q_max(size_of(a), size_of(b));
  if (size < expected_q14 / FAINT) return (expected_q14 / FAINT > floor_q14) ? WIRING_NO_CURRENT : WIRING_GOOD;
  return (size / CLEAR > floor_q14) ? name_of(a, b) : WIRING_GOOD;
}

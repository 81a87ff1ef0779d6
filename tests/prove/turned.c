// A rotation turned on (estimators/deviation.c), slice by slice of the circle and of the angle: what is read elsewhere
// with the promise of rotation_ranges.h.

#include "estimators/deviation.c"
#include "tests/prove/any.h"

#define SLICES 128L
#define ANGLES 32L
#define ANGLE_END_Q30 1073741824L  // 1 rad: more than half a period at 1.9 rad per period

static int32_t any_between(int32_t a, int32_t b) { return any_from(q_min(a, b) - 4, q_max(a, b) + 4); }

static void turn(rotation_t from, rotation_t to) {
  const rotation_t r = {any_between(from.sin_q30, to.sin_q30), any_between(from.cos_q30, to.cos_q30)};
  //@ loop unroll ANGLES;
  for (int32_t k = 0; k < ANGLES; k++) {
    const int32_t least_q30 = -ANGLE_END_Q30 + ANGLE_END_Q30 / (ANGLES / 2) * k;
    (void)turned(r, any_from(least_q30, least_q30 + ANGLE_END_Q30 / (ANGLES / 2) + ANGLES));
  }
}

// Sine and cosine rise or fall all along a slice.
void prove_turned(void) {
  rotation_t from = frame_rotation(0);
  //@ loop unroll SLICES;
  for (uint32_t k = 1; k <= SLICES; k++) {
    const rotation_t to = frame_rotation(k * (0xFFFFFFFFuL / SLICES + 1uL));
    turn(from, to);
    from = to;
  }
}

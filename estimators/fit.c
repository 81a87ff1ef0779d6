#include "estimators/fit.h"

// A 64-bit magnitude as 31 bits and a power of two.
static int16_t normalise(uint64_t* x) {
  int16_t exponent = 0;
  while (*x > (uint64_t)INT32_MAX) {
    *x >>= 1;
    exponent++;
  }
  while (*x != 0u && *x <= (uint64_t)(INT32_MAX / 2)) {
    *x <<= 1;
    exponent--;
  }
  return exponent;
}

static uint64_t magnitude(int64_t x) { return (x < 0) ? (uint64_t)0 - (uint64_t)x : (uint64_t)x; }

int32_t fit_ratio(int64_t numerator, int64_t denominator, int16_t shift) {
  const bool negative = (numerator < 0) != (denominator < 0);
  uint64_t n = magnitude(numerator);
  uint64_t d = magnitude(denominator);
  if (n == 0u) return 0;
  const int16_t scale = (int16_t)(shift + normalise(&n) - normalise(&d));
  const int32_t limit = negative ? INT32_MIN : INT32_MAX;
  if (d == 0u || scale > 31) return limit;
  // The quotient of the two mantissas lies between 1/2 and 2: halved once it may still round to 1.
  const int32_t small = (scale == -1 && n >= d) ? 1 : 0;
  const int32_t quotient = (scale >= 0) ? q_div((int32_t)n, (int32_t)d, (unsigned)scale) : small;
  return negative ? q_neg_sat(quotient) : quotient;
}

int64_t fit_dot(const int32_t* a, const int32_t* b, uint16_t n) {
  int64_t sum = 0;
  for (uint16_t k = 0; k < n; k++) sum += (int64_t)a[k] * b[k];
  return sum;
}

// What a column leaves of another, within 2^29 as columns are.
static void take_off(int32_t* rest, const int32_t* y, int32_t factor_q24, const int32_t* x, uint16_t n) {
  for (uint16_t k = 0; k < n; k++)
    rest[k] = q_sat_bits((int64_t)y[k] * 16777216L - q_product(factor_q24, x[k]), 24, 29);
}

// The second regressor less what the first explains; then each is fitted on its own.
bool fit_plane(const int32_t* x, const int32_t* f, const int32_t* y, uint16_t n, fit_plane_t* out) {
  int32_t own[FIT_POINTS];
  int32_t rest[FIT_POINTS];
  const int64_t xx = fit_dot(x, x, n);
  const int32_t shared_q24 = fit_ratio(fit_dot(x, f, n), xx, 24);
  take_off(own, f, shared_q24, x, n);
  const int64_t own_square = fit_dot(own, own, n);
  if (xx == 0 || own_square < q_shr64(fit_dot(f, f, n), 10)) return false;
  out->offset_q24 = fit_ratio(fit_dot(own, y, n), own_square, 24);
  take_off(rest, y, out->offset_q24, f, n);
  out->slope_q24 = fit_ratio(fit_dot(x, rest, n), xx, 24);
  take_off(rest, rest, out->slope_q24, x, n);
  out->rms = (int32_t)q_sqrt64((uint64_t)fit_dot(rest, rest, n) / n);
  return true;
}

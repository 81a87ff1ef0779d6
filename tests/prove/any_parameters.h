// Parameters with every value anywhere in the range that the table gives it.

#ifndef STILLSPIN_TESTS_PROVE_ANY_PARAMETERS_H
#define STILLSPIN_TESTS_PROVE_ANY_PARAMETERS_H

#include "firmware/dictionary/parameters.h"
#include "hal/hal_board.h"
#include "tests/prove/any.h"

// The raw value of a decimal one, worked out by the compiler: intervals lose a limit that the drive unpacks.
#define TEN_0 1LL
#define TEN_1 10LL
#define TEN_2 100LL
#define TEN_3 1000LL
#define TEN_4 10000LL
#define TEN_5 100000LL
#define TEN_6 1000000LL
#define RAW(value, q, ten) \
  (int32_t)((((value) < 0 ? -1LL : 1LL) * (ten) / 2 + (long long)(value) * (1LL << (q))) / (ten))

static inline void any_parameters(void) {
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  parameters.name = any_from(RAW(minimum, q, TEN_##decimals), RAW(maximum, q, TEN_##decimals));
#include "firmware/dictionary/all_parameters.h"
#undef PARAMETER
}

#endif

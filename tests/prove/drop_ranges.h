// What drops and delays of the devices promise, of a configuration that dead_time_design has made, in ACSL: the part
// drops shows it, band by band; what calls them is read with these lines in their place.

#ifndef STILLSPIN_TESTS_PROVE_DROP_RANGES_H
#define STILLSPIN_TESTS_PROVE_DROP_RANGES_H

#include "svpwm/dead_time.h"
#include "tests/prove/ends.h"
#include "tests/prove/qmath_ranges.h"  // before what it is about

/*@ requires \valid_read(c); assigns \result \from *c, current_q20; ensures WITHIN(\result, SIGN_END_Q21); */
static inline int32_t dead_time_sign_q21(const dead_time_config_t* c, int32_t current_q20);

/*@ requires \valid_read(c); assigns \result \from *c, blocking_q20; ensures FROM_TO(\result, -130, 370); */
static inline int32_t dead_time_delay_ticks(const dead_time_config_t* c, int32_t blocking_q20);

#endif

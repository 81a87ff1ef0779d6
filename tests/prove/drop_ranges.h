// What the drops of the devices promise, of a configuration that dead_time_design has made, in ACSL: the part drops
// shows it, band by band; what calls them is read with these lines in their place.

#ifndef STILLSPIN_TESTS_PROVE_DROP_RANGES_H
#define STILLSPIN_TESTS_PROVE_DROP_RANGES_H

#include "svpwm/dead_time.h"
#include "tests/prove/ends.h"
#include "tests/prove/qmath_ranges.h"  // before what it is about

/*@ requires \valid_read(c) && VECTOR_AB(current_q20, CARRIED_MAX_Q20);
    assigns \result \from *c, current_q20; ensures VECTOR_AB(\result, DROP_END_Q16); */
static inline ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20);

#endif

// The layouts are read by themselves (svpwm.c, part layouts): what chooses among them is read with these lines in their
// place.

#ifndef STILLSPIN_TESTS_PROVE_SVPWM_RANGES_H
#define STILLSPIN_TESTS_PROVE_SVPWM_RANGES_H

#include "svpwm/alternating.h"
#include "svpwm/extended.h"
#include "tests/prove/qmath_ranges.h"  // before what it is about

/*@ assigns \result \from *t, pulse_ticks; ensures \result == 0 || \result == 1; */
bool svpwm_alternating_fits(const svpwm_on_time_t* t, int16_t pulse_ticks);

/*@ assigns *s \from *s; assigns *pulses \from *s, *t, pulse_ticks; */
void svpwm_alternating(alternating_state_t* s, const svpwm_on_time_t* t, int16_t pulse_ticks, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *c, *t; */
void svpwm_extended(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *c, *t; */
void svpwm_cheapest_pair(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *t; */
void svpwm_centred(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *t; */
void svpwm_long_zero(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

#endif

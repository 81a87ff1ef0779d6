// The layouts are proved by themselves (layouts.c): what chooses among them is read with these lines in their place.

#ifndef STILLSPIN_TESTS_PROVE_SVPWM_RANGES_H
#define STILLSPIN_TESTS_PROVE_SVPWM_RANGES_H

#include "svpwm/alternating.h"
#include "svpwm/extended.h"
#include "tests/prove/ends.h"
#include "tests/prove/qmath_ranges.h"  // before what it is about

// -1 is none at all (firmware/start/flying/flying.c).
#define OF_EDGE(tick) FROM_TO(tick, -1, SVPWM_PERIOD_TICKS)
#define OF_EDGES(at) \
  (OF_EDGE((at)[0]) && OF_EDGE((at)[1]) && OF_EDGE((at)[2]) && OF_EDGE((at)[3]) && OF_EDGE((at)[4]) && OF_EDGE((at)[5]))

// Numbers of edges.
#define OF_ORDER(order) \
  ((order)[0] <= 5 && (order)[1] <= 5 && (order)[2] <= 5 && (order)[3] <= 5 && (order)[4] <= 5 && (order)[5] <= 5)

#define EDGE_WRITTEN(p, k) \initialized(&(p)->at[k])
#define LEG_WRITTEN(p, leg) (EDGE_WRITTEN(p, leg) && EDGE_WRITTEN(p, (leg) + 3))
#define PLACE_WRITTEN(p, k) \initialized(&(p)->order[k])
#define ORDER_WRITTEN(p)                                                                                              \
  (PLACE_WRITTEN(p, 0) && PLACE_WRITTEN(p, 1) && PLACE_WRITTEN(p, 2) && PLACE_WRITTEN(p, 3) && PLACE_WRITTEN(p, 4) && \
   PLACE_WRITTEN(p, 5))
#define WRITTEN(p) (LEG_WRITTEN(p, 0) && LEG_WRITTEN(p, 1) && LEG_WRITTEN(p, 2) && ORDER_WRITTEN(p))

/*@ assigns \result \from *t, pulse_ticks; ensures \result == 0 || \result == 1; */
static inline bool svpwm_alternating_fits(const svpwm_on_time_t* t, int16_t pulse_ticks);

/*@ assigns *s \from *s; assigns *pulses \from *s, *t, pulse_ticks;
    ensures FROM_TO(s->leg, 0, 2); ensures FLAG(s->pair_first);
    ensures WRITTEN(pulses);
    ensures OF_EDGES(pulses->at); ensures OF_ORDER(pulses->order); */
void svpwm_alternating(alternating_state_t* s, const svpwm_on_time_t* t, int16_t pulse_ticks, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *c, *t;
    ensures WRITTEN(pulses); ensures OF_EDGES(pulses->at); ensures OF_ORDER(pulses->order); */
void svpwm_extended(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *c, *t;
    ensures WRITTEN(pulses); ensures OF_EDGES(pulses->at); ensures OF_ORDER(pulses->order); */
void svpwm_cheapest_pair(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *t;
    ensures WRITTEN(pulses); ensures OF_EDGES(pulses->at); ensures OF_ORDER(pulses->order); */
void svpwm_centred(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ assigns *pulses \from *t;
    ensures WRITTEN(pulses); ensures OF_EDGES(pulses->at); ensures OF_ORDER(pulses->order); */
void svpwm_long_zero(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

#endif

// What the modulator promises, in ACSL: the parts svpwm and edges read its code and show it, the part interrupt takes
// it in the code's place.

#ifndef STILLSPIN_TESTS_PROVE_MODULATOR_RANGES_H
#define STILLSPIN_TESTS_PROVE_MODULATOR_RANGES_H

#include "svpwm/edges.h"
#include "svpwm/modulator.h"
#include "tests/prove/svpwm_ranges.h"

// That a window ends behind its start no interval knows, nor which are kept: one that is not may begin behind the
// period.
#define OF_WINDOW(w) (FROM_TO((w).start, 0, 12740) && FROM_TO((w).end, -1000, 9800) && FROM_TO((w).state, 0, 7))
#define OF_WINDOWS(p) (OF_WINDOW((p)->windows[0]) && OF_WINDOW((p)->windows[1]) && OF_WINDOW((p)->windows[2]))

/*@ requires \valid(s) && \valid_read(c) && \valid(pulses) && VECTOR_AB(voltage_q16, ASKED_MAX_Q16);
    requires FROM_TO(link_q16, 0, VOLTAGE_MAX_Q16);
    assigns *s, *pulses, \result \from *s, *c, excitation, voltage_q16, link_q16;
    ensures FLAG(s->is_alternating); ensures FLAG(s->alternating.pair_first) && FROM_TO(s->alternating.leg, 0, 2);
    ensures FLAG(\result.limited); ensures VECTOR_AB(\result.realised_q16, ASKED_MAX_Q16);
    ensures \initialized(&pulses->at[0 .. 5]) && \initialized(&pulses->order[0 .. 5]);
    ensures OF_EDGES(pulses->at) && OF_ORDER(pulses->order); */
modulator_result_t modulator_step(modulator_t* s, const modulator_config_t* c, excitation_t excitation,
                                  ab_t voltage_q16, int32_t link_q16, svpwm_pulses_t* pulses);

/*@ requires \valid_read(c) && \valid_read(sampling) && \valid_read(carried) && \valid(pattern);
    requires \valid(sent + (0 .. 5));
    requires \initialized(&pattern->pulses.at[0 .. 5]) && OF_EDGES(pattern->pulses.at);
    requires \initialized(&pattern->pulses.order[0 .. 5]) && OF_ORDER(pattern->pulses.order);
    requires \initialized(&pattern->windows[0 .. 2]) && OF_WINDOWS(pattern);
    requires VECTOR_ABC(carried->shares_q12, SHARE_END_Q12);
    requires FROM_TO(carried->inverse_inductance_q30, 0, Y_END_Q30);
    requires FROM_TO(carried->link_q16, 0, VOLTAGE_MAX_Q16);
    assigns pattern->windows[0 .. 2], pattern->window_count, sent[0 .. 5]
            \from *c, *sampling, *carried, *pattern;
    ensures FROM_TO(pattern->window_count, 0, 3); ensures OF_WINDOWS(pattern);
    ensures \initialized(&sent[0 .. 5]); */
void svpwm_compensate_edges(const dead_time_config_t* c, const sampling_config_t* sampling,
                            const svpwm_carried_t* carried, svpwm_pattern_t* pattern, uint16_t sent[]);

/*@ requires \valid_read(p) && OF_EDGES(p->at) && FROM_TO(link_q16, 0, VOLTAGE_MAX_Q16);
    assigns \result \from *p, link_q16; ensures VECTOR_AB(\result, 2 * VOLTAGE_MAX_Q16); */
ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16);

/*@ requires OF_EDGES(p->at) && FROM_TO(link_q16, 0, VOLTAGE_MAX_Q16);
    requires \valid_read(p) && count <= 3 && (count == 0 || \valid_read(ticks + (0 .. count - 1)));
    assigns \result \from *p, ticks[0 .. 2], count, link_q16; ensures VECTOR_AB(\result, RIPPLE_MAX_Q16); */
ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, const int16_t ticks[], uint16_t count, int32_t link_q16);

#endif

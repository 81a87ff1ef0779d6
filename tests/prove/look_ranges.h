// What the deviation observer sees in a period (estimators/deviation_observer.c), in ACSL; it is read by itself, with
// windows of all spans (look.c).

#ifndef STILLSPIN_TESTS_PROVE_LOOK_RANGES_H
#define STILLSPIN_TESTS_PROVE_LOOK_RANGES_H

#include "estimators/deviation_information.h"
#include "tests/prove/ends.h"
#include "tests/prove/qmath_ranges.h"

#define CHANGE_MAX_BPP 8388608L  // of a period's torque, foreseen

/*@ requires \valid(left) && \valid_read(n) && VECTOR_DQ(n->e_q17, LEFT_END_Q17);
    requires FROM_TO(n->span_ticks, 0, 30000); */
static void leave(deviation_residual_t* left, const information_sums_t* n);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in) && FROM_TO(in->window_count, 1, ESTIMATOR_WINDOWS);
    requires WITHIN(s->speed_bpp, SPEED_MAX_BPP + CHANGE_MAX_BPP);
    assigns s->residual, s->sensitivity, s->is_sensitive, s->regression, s->regressed_bam, \result
            \from *s, *c, indirect:*in;
    ensures FROM_TO(\result.aa, 0, INFORMATION_MAX) && FROM_TO(\result.ss, 0, INFORMATION_MAX);
    ensures FLAG(s->is_sensitive); */
static information_t look(deviation_observer_t* s, const deviation_observer_config_t* c, const estimator_input_t* in);

#endif

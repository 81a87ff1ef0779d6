// What the estimators of the start and of the commissioning promise, in ACSL: the parts start and commissioning read
// their code and show it, the part interrupt takes it in the code's place.

#ifndef STILLSPIN_TESTS_PROVE_START_RANGES_H
#define STILLSPIN_TESTS_PROVE_START_RANGES_H

#include "estimators/axis.h"
#include "estimators/emf_sign.h"
#include "estimators/flying.h"
#include "estimators/followed.h"
#include "estimators/inertia_match.h"
#include "estimators/inverse_inductance_tensor.h"
#include "estimators/polarity.h"
#include "estimators/saturation.h"
#include "estimators/wiring.h"
#include "tests/prove/ends.h"
#include "tests/prove/qmath_ranges.h"

/*@ requires \valid(s) && FROM_TO(s->passes, 1, 6) && FROM_TO(s->length, 20, 160) && FROM_TO(s->tick, 0, 159);
    requires FROM_TO(s->segment, 0, 6);
    assigns *s, \result \from *s, angle_bam;
    ensures WITHIN(\result, CURRENT_MAX_Q20) && FROM_TO(s->result, 0, 3) && FROM_TO(s->passes, 1, 6);
    ensures FROM_TO(s->tick, 0, 159) && FROM_TO(s->segment, 0, 6) && FROM_TO(s->length, 20, 160); */
int32_t polarity_step(polarity_t* s, uint32_t angle_bam);

/*@ requires \valid(s) && \valid_read(r) && \valid_read(m) && FROM_TO(s->passes, 0, 8);
    requires FROM_TO(s->tick, 0, SATURATION_LENGTH); assigns *s, \result \from *s, *r, *m;
    ensures WITHIN(\result, CURRENT_MAX_Q20) && FROM_TO(s->result, 0, 3);
    ensures FROM_TO(s->passes, 0, 8) && FROM_TO(s->tick, 0, SATURATION_LENGTH); */
int32_t saturation_step(saturation_t* s, const regression_t* r, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(m) && \valid_read(slopes); assigns *s \from *m, *slopes, current_q20;
    ensures FROM_TO(s->result, 0, 3) && FROM_TO(s->passes, 0, 8) && s->tick == 0; */
void saturation_begin(saturation_t* s, const machine_model_t* m, const saturation_slopes_t* slopes,
                      int32_t current_q20);

/*@ requires \valid_read(s) && \valid_read(m); assigns \result \from *s, *m; */
int32_t saturation_resistance_q24(const saturation_t* s, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(r); assigns *s \from *s, *r; */
void axis_add(axis_t* s, const regression_t* r);

/*@ requires \valid_read(s) && \valid_read(m); assigns \result \from *s, *m;
    ensures WITHIN(\result.angle_bam, 1073741824); */
axis_result_t axis_evaluate(const axis_t* s, const machine_model_t* m);

/*@ requires \valid(f) && FROM_TO(length, 4, 32767); assigns *f \from *f, tick, length, reference_q20, flows_q20; */
void followed_step(followed_t* f, int16_t tick, int16_t length, int32_t reference_q20, int32_t flows_q20);

/*@ requires \valid_read(s) && \valid_read(m); assigns \result \from *s, *m, code_q20;
    ensures FROM_TO(\result, 0, 11); */
wiring_t wiring_judge(const axis_t* s, const machine_model_t* m, int32_t code_q20);

/*@ requires \valid(s) && \valid_read(m) && \valid_read(w); assigns *s \from *s, *m, *w, tick; */
void flying_add(flying_pulse_t* s, const machine_model_t* m, const estimator_window_t* w, int32_t tick);

/*@ requires \valid_read(s) && \valid_read(m); assigns \result \from *s, *m;
    ensures FROM_TO(\result.size_q16, 0, 2147483647); */
flying_emf_t flying_evaluate(const flying_pulse_t* s, const machine_model_t* m);

/*@ requires \valid_read(e) && \valid_read(m); assigns \result \from *e, *m, least, most;
    ensures least <= \result <= most; */
int32_t flying_pause(const flying_emf_t* e, const machine_model_t* m, int32_t least, int32_t most);

/*@ requires \valid_read(first) && \valid_read(second) && \valid_read(m) && \valid(rotor);
    assigns *rotor, \result \from *first, *second, *m; ensures \initialized(rotor); ensures FLAG(\result);
    ensures WITHIN(rotor->speed_bpp, SPEED_MAX_BPP); */
bool flying_resolve(const flying_emf_t* first, const flying_emf_t* second, const machine_model_t* m,
                    flying_rotor_t* rotor);

/*@ requires \valid(s) && \valid_read(m) && \valid_read(seen); assigns *s \from *s, *m, *seen; */
void emf_sign_look(emf_sign_t* s, const machine_model_t* m, const emf_sign_seen_t* seen);

/*@ requires \valid(s) && \valid_read(m); assigns *s, \result \from *s, *m, speed_bpp;
    ensures FROM_TO(\result, 0, 2); */
emf_sign_result_t emf_sign_judge(emf_sign_t* s, const machine_model_t* m, int32_t speed_bpp);

/*@ requires \valid(s) && \valid_read(first) && \valid_read(second); assigns *s \from *s, *first, *second;
    ensures FROM_TO(s->count, 0, 2147483647); */
void tensor_add(tensor_sums_t* s, const deviation_t* first, const deviation_t* second);

/*@ requires \valid(s) && \valid_read(in); assigns *s, \result \from *s, *in, periods;
    ensures FROM_TO(\result, RATIO_MIN_Q24, RATIO_MAX_Q24); ensures FROM_TO(s->ratio_q24, RATIO_MIN_Q24, RATIO_MAX_Q24);
    ensures FROM_TO(s->phase, 0, 2); */
int32_t inertia_match_step(inertia_match_t* s, const inertia_seen_t* in, int32_t periods);

#endif

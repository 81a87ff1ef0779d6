// What the estimators of the position, and what learns from them, promise, in ACSL: the parts estimators, observer and
// flux read their code and show it, the part interrupt takes it in the code's place.

#ifndef STILLSPIN_TESTS_PROVE_ESTIMATORS_RANGES_H
#define STILLSPIN_TESTS_PROVE_ESTIMATORS_RANGES_H

#include "estimators/avv.h"
#include "estimators/deviation.h"
#include "estimators/deviation_observer.h"
#include "estimators/flux_observer.h"
#include "estimators/inverse_inductance.h"
#include "estimators/sensor_match.h"
#include "estimators/slopes.h"
#include "estimators/synchronism.h"
#include "estimators/voltage_match.h"
#include "estimators/zvv.h"
#include "tests/prove/ends.h"
#include "tests/prove/qmath_ranges.h"

#define OF_LEARNT(m)                                                                                                 \
  (FROM_TO((m)->trim.mean_q30, -Y0_END_Q30 / 4, Y0_END_Q30 / 2) && WITHIN((m)->trim.half_q30, Y_END_Q30) &&          \
   FROM_TO((m)->trim.ydd_q24, LEAST_SHARE_Q24, 16777216) && FROM_TO((m)->trim.yqq_q24, LEAST_SHARE_Q24, 16777216) && \
   FROM_TO((m)->trim.ydq_q24, LEAST_SHARE_Q24, 16777216) &&                                                          \
   FROM_TO((m)->trim.rs_q24, -RS_NOMINAL_MAX_Q24 / 2, RS_NOMINAL_MAX_Q24) &&                                         \
   WITHIN((m)->trim.psi_q16, TRIM_FLUX_END_Q16))
#define OF_VARIANCE(x_q20) FROM_TO(x_q20, 16, 536870912)
#define OF_OUTPUT(x) (WITHIN((x).speed_bpp, SPEED_MAX_BPP) && FROM_TO((x).quality_q15, 0, 32767))

/*@ requires \valid(m) && \valid_read(r); assigns m->trim \from *m, *r, per_spread, share_q30; ensures OF_LEARNT(m); */
void inverse_inductance_step(machine_model_t* m, const regression_t* r, q_inverse_t per_spread, int32_t share_q30);

/*@ requires \valid(m); assigns m->trim \from *m, mean_q30, half_q30; ensures OF_LEARNT(m); */
void inverse_inductance_preset(machine_model_t* m, int32_t mean_q30, int32_t half_q30);

/*@ requires \valid(m); assigns m->trim \from *m, more_q24; ensures OF_LEARNT(m); */
void voltage_match_resistance(machine_model_t* m, int32_t more_q24);

/*@ requires \valid(m) && \valid_read(r); assigns m->trim \from *m, *r, w_q30, share_q30; ensures OF_LEARNT(m); */
void voltage_match_step(machine_model_t* m, const regression_t* r, int32_t w_q30, int32_t share_q30);

/*@ requires \valid(mismatch_q30) && \valid_read(r); assigns *mismatch_q30 \from *mismatch_q30, *r, per_spread,
   per_y0, share_q30; ensures WITHIN(*mismatch_q30, MISMATCH_END_Q30); */
void sensor_match_step(int32_t* mismatch_q30, const regression_t* r, q_inverse_t per_spread, q_inverse_t per_y0,
                       int32_t share_q30);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in); assigns *s, \result \from *s, *c, indirect:*in;
    ensures OF_OUTPUT(\result); ensures WITHIN(s->observer.speed_bpp, SPEED_MAX_BPP); */
estimator_output_t avv_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in); assigns *s, \result \from *s, *c, indirect:*in;
    ensures OF_OUTPUT(\result); ensures WITHIN(s->observer.speed_bpp, SPEED_MAX_BPP); */
estimator_output_t avv_printed_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in); assigns *s, \result \from *s, *c, indirect:*in;
    ensures OF_OUTPUT(\result); ensures WITHIN(s->speed_bpp, SPEED_MAX_BPP) && FROM_TO(s->waited, 0, 10); */
estimator_output_t zvv_step(zvv_t* s, const zvv_config_t* c, const estimator_input_t* in, int32_t id_reference_q20);

/*@ requires \valid_read(in) && \valid(deviation_q20);
    assigns *deviation_q20, \result \from *deviation_q20, indirect:*in, angle_bam, speed_bpp; ensures FLAG(\result); */
bool zvv_deviation_q20(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, int32_t* deviation_q20);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in); assigns *s, \result \from *s, *c, indirect:*in;
    ensures OF_OUTPUT(\result); ensures WITHIN(s->speed_bpp, SPEED_MAX_BPP) && FROM_TO(s->speed_remainder_q8, 0, 255);
    ensures FLAG(s->load_is_new) && FLAG(s->load_step_suspected) && FLAG(s->is_sensitive) && FLAG(s->cogging.active);
    ensures OF_VARIANCE(s->p_aa) && OF_VARIANCE(s->p_ss) && OF_VARIANCE(s->p_ll);
    ensures WITHIN(s->p_as, VARIANCE_END_Q20) && WITHIN(s->p_al, VARIANCE_END_Q20);
    ensures WITHIN(s->p_sl, VARIANCE_END_Q20) && FROM_TO(s->cogging.known_q30, 0, 1073741824);
    ensures FROM_TO(s->score_power_q23, 0, POWER_END_Q23) && s->score_remainder <= 255;
    ensures FROM_TO(s->noise_boost_q30, 0, 1073741824) && FROM_TO(s->gathered.periods, 0, 11);
    ensures FROM_TO(s->gathered.aa_q21, 0, s->gathered.periods * INFORMATION_END_Q21);
    ensures FROM_TO(s->gathered.ss_q21, 0, s->gathered.periods * INFORMATION_END_Q21);
    ensures FROM_TO(s->gathered.as_q24, s->gathered.periods * -2147483648LL, s->gathered.periods * 2147483647LL);
    ensures WITHIN(s->cogging.cos_q8, 1073741823) && WITHIN(s->cogging.sin_q8, 1073741823); */
estimator_output_t deviation_observer_step(deviation_observer_t* s, const deviation_observer_config_t* c,
                                           const estimator_input_t* in);

/*@ requires \valid(s) && \valid_read(c); assigns s->cogging, s->load_accel_q8 \from *s, *c;
    ensures WITHIN(s->cogging.cos_q8, 1073741823) && WITHIN(s->cogging.sin_q8, 1073741823);
    ensures FLAG(s->cogging.active) && FROM_TO(s->cogging.known_q30, 0, 1073741824); */
void deviation_observer_learn(deviation_observer_t* s, const deviation_observer_config_t* c);

/*@ requires \valid(s) && \valid(residual_q20) && \valid(span_ticks) && \valid(periods);
    assigns s->residual, *residual_q20, *span_ticks, *periods, \result
            \from s->residual, *residual_q20, *span_ticks, *periods;
    ensures FLAG(\result); */
bool deviation_observer_take_mean_residual(deviation_observer_t* s, dq_t* residual_q20, int32_t* span_ticks,
                                           int32_t* periods);

/*@ requires \valid_read(m); assigns \result \from *m, w_q30; */
deviation_model_t deviation_model(const machine_model_t* m, int32_t w_q30);

/*@ requires FROM_TO(count, 1, ESTIMATOR_WINDOWS);
    requires \valid_read(at) && \valid_read(windows + (0 .. count - 1)) && \valid_read(frames + (0 .. count - 1));
    requires \valid(seen + (0 .. count - 1));
    assigns seen[0 .. count - 1] \from *at, windows[0 .. count - 1], frames[0 .. count - 1], iq_q18; */
void deviation_changes(const deviation_model_t* at, const estimator_window_t windows[],
                       const estimator_frame_t frames[], uint16_t count, int32_t iq_q18, deviation_change_t seen[]);

/*@ requires \valid_read(c); assigns \result \from *c, span_ticks;
    ensures VECTOR_DQ(\result.voltage_q16, 5000 * VOLTS_Q16); */
deviation_t deviation_slope(const deviation_change_t* c, int32_t span_ticks);

/*@ requires \valid_read(m) && \valid_read(w); assigns \result \from *m, *w, angle_bam, speed_bpp;
    ensures VECTOR_DQ(\result.voltage_q16, 5000 * VOLTS_Q16); */
deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in) && \valid_read(period);
    assigns *s, \result \from *s, *c, indirect:*in, *period;
    ensures OF_OUTPUT(\result) && WITHIN(s->observer.speed_bpp, SPEED_MAX_BPP); */
estimator_output_t flux_observer_step(flux_observer_t* s, const flux_observer_config_t* c, const estimator_input_t* in,
                                      const flux_period_t* period);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(m); assigns *s \from *c, *m;
    ensures WITHIN(s->observer.speed_bpp, SPEED_MAX_BPP); */
void flux_observer_reset(flux_observer_t* s, const flux_observer_config_t* c, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(now); assigns *s \from *s, *now, current_q20;
    ensures WITHIN(s->observer.speed_bpp, SPEED_MAX_BPP); */
void flux_observer_preset(flux_observer_t* s, const estimator_output_t* now, dq_t current_q20);

/*@ requires \valid(s); assigns *s \from *s; ensures WITHIN(s->observer.speed_bpp, SPEED_MAX_BPP); */
void flux_observer_keep(flux_observer_t* s);

/*@ requires \valid(seen) && \valid_read(m) && \valid_read(windows + (0 .. count - 1));
    assigns seen->residual_q20, seen->span_ticks \from *m, windows[0 .. 2], count, angle_bam;
    ensures FROM_TO(seen->span_ticks, 0, 30000); */
void synchronism_look(synchronism_seen_t* seen, const machine_model_t* m, const estimator_window_t windows[],
                      uint16_t count, uint32_t angle_bam);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(m) && \valid_read(seen);
    assigns *s, \result \from *s, *c, *m, *seen, apart_bam;
    ensures FLAG(\result); ensures FROM_TO(s->limit_q16, 0, 32768000); */
bool synchronism_judge(synchronism_t* s, const synchronism_config_t* c, const machine_model_t* m,
                       const synchronism_seen_t* seen, int32_t apart_bam);

/*@ requires \valid_read(c) && \valid_read(sums) && \valid(w) && c->start_samples == START_SAMPLES;
    requires c->end_samples == END_SAMPLES && FROM_TO(c->offset_a_q13, 768 * OFFSET_MIN_Q8, 768 * OFFSET_MAX_Q8);
    requires FROM_TO(c->offset_b_q13, 768 * OFFSET_MIN_Q8, 768 * OFFSET_MAX_Q8);
    requires FROM_TO(c->alpha_a_q36, -GAIN_MAX_Q36 / 20, GAIN_MAX_Q36);
    requires FROM_TO(c->beta_a_q36, -GAIN_MAX_Q36 / 20, GAIN_MAX_Q36 / 10 * 6);
    requires FROM_TO(c->beta_b_q36, -GAIN_MAX_Q36 / 10, GAIN_MAX_Q36 / 10 * 12);
    assigns w->change_q19, w->current_q20 \from *c, *sums;
    ensures VECTOR_AB(w->change_q19, CHANGE_MAX_Q19); ensures WITHIN(w->current_q20.alpha, WINDOW_ALPHA_MAX_Q20);
    ensures WITHIN(w->current_q20.beta, WINDOW_BETA_MAX_Q20); */
void slopes_evaluate(const slopes_scale_t* c, const slopes_sums_t* sums, estimator_window_t* w);

#endif

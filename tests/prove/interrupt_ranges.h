// What the control interrupt's glue (firmware/) may believe of the floors below it, in ACSL: what a step changes and
// within which ranges. The parts that read those floors by themselves show that, or have left it open there.

#ifndef STILLSPIN_TESTS_PROVE_INTERRUPT_RANGES_H
#define STILLSPIN_TESTS_PROVE_INTERRUPT_RANGES_H

#include "firmware/drive.h"
#include "tests/prove/qmath_ranges.h"

#define FLAG(x) ((x) == 0 || (x) == 1)
#define WITHIN(x, most) (-(most) <= (x) && (x) <= (most))
#define FROM_TO(x, least, most) ((least) <= (x) && (x) <= (most))
#define SPEED_END 1298773986       // 1.9 rad per period
#define FLUX_END 2097152000        // any_model.h
#define CURRENT_END 536870912      // 512 A
#define ADMITTANCE_END 1288490189  // 1.2 A per V and period
#define VOLTS_1000 65536000

#define OF_OUTPUT(x) (WITHIN((x).speed_bpp, SPEED_END) && FROM_TO((x).quality_q15, 0, 32767))
#define OF_ADMITTANCE(m)                                                                             \
  (FROM_TO((m)->yd_q30, 1, ADMITTANCE_END) && FROM_TO((m)->yq_q30, 1, ADMITTANCE_END) &&             \
   WITHIN((m)->ydq_q30, ADMITTANCE_END / 2) && FROM_TO((m)->per_yq.value, 1073741824, 2147483647) && \
   FROM_TO((m)->per_yq.exponent, 31, 61))
#define OF_TURN(m)                                                                           \
  (WITHIN((m)->k_dd_q24, 1056964608 / 2) && FROM_TO((m)->k_dq_q24, -16777216, 1056964608) && \
   FROM_TO((m)->k_qd_q24, -1056964608, 16777216) && WITHIN((m)->k0_q20.d, 1048576000) &&     \
   WITHIN((m)->k0_q20.q, 1048576000))
#define OF_TRIM(m)                                                                   \
  (WITHIN((m)->trim.mean_q30, 322122547) && WITHIN((m)->trim.half_q30, 322122547) && \
   FROM_TO((m)->trim.rs_q24, -419430400, 838860800) && WITHIN((m)->trim.psi_q16, 786432000))
#define OF_REGRESSION(r) (FROM_TO((r).spread_q8, 0, 2147483647) && FROM_TO((r).information, 0, 2147483647))

#define OF_FRAME(f)                                                                    \
  (WITHIN((f).current_q20.d, CURRENT_END) && WITHIN((f).current_q20.q, CURRENT_END) && \
   WITHIN((f).rotation.sin_q30, 1202590842) && WITHIN((f).rotation.cos_q30, 1202590842))
#define OF_WINDOW(w) (FROM_TO((w).start, 0, 10000) && FROM_TO((w).end, 0, 10000) && FROM_TO((w).state, 0, 7))
#define OF_EDGES(at)                                                                         \
  (FROM_TO((at)[0], 0, 10000) && FROM_TO((at)[1], 0, 10000) && FROM_TO((at)[2], 0, 10000) && \
   FROM_TO((at)[3], 0, 10000) && FROM_TO((at)[4], 0, 10000) && FROM_TO((at)[5], 0, 10000))

// control/machine_model.h

/*@ requires \valid(m);
    assigns m->iq_q20, m->rs_q24, m->yd_q30, m->yq_q30, m->ydq_q30, m->per_yq, m->k_dd_q24, m->k_dq_q24, m->k_qd_q24,
            m->k0_q20, m->psi_d_q16, m->psi_q_q16 \from *m, iq_q20;
    ensures FROM_TO(m->rs_q24, 8388, 704643072) && OF_ADMITTANCE(m) && OF_TURN(m);
    ensures WITHIN(m->psi_d_q16, FLUX_END) && WITHIN(m->psi_q_q16, FLUX_END) && WITHIN(m->iq_q20, 2 * CURRENT_END); */
void machine_model_move(machine_model_t* m, int32_t iq_q20);

/*@ requires \valid(m);
    assigns m->iq_q20, m->rs_q24, m->yd_q30, m->yq_q30, m->ydq_q30, m->k0_q20, m->psi_d_q16, m->psi_q_q16
            \from *m, iq_q20;
    ensures FROM_TO(m->rs_q24, 8388, 704643072) && OF_ADMITTANCE(m) && OF_TURN(m);
    ensures WITHIN(m->psi_d_q16, FLUX_END) && WITHIN(m->psi_q_q16, FLUX_END) && WITHIN(m->iq_q20, 2 * CURRENT_END); */
void machine_model_follow(machine_model_t* m, int32_t iq_q20);

/*@ requires \valid(m); assigns m->per_yq, m->k_dd_q24, m->k_dq_q24, m->k_qd_q24, m->k0_q20 \from *m;
    ensures OF_ADMITTANCE(m) && OF_TURN(m); */
void machine_model_turn(machine_model_t* m);

// What is learnt of the machine and of the sensors

/*@ requires \valid(m) && \valid_read(r); assigns m->trim \from *m, *r, share_q30; ensures OF_TRIM(m); */
void admittance_step(machine_model_t* m, const regression_t* r, int32_t share_q30);

/*@ requires \valid(m); assigns m->trim \from *m, mean_q30, half_q30; ensures OF_TRIM(m); */
void admittance_preset(machine_model_t* m, int32_t mean_q30, int32_t half_q30);

/*@ requires \valid(m); assigns m->trim \from *m, more_q24; ensures OF_TRIM(m); */
void voltage_match_resistance(machine_model_t* m, int32_t more_q24);

/*@ requires \valid(m) && \valid_read(r); assigns m->trim \from *m, *r, w_q30, share_q30; ensures OF_TRIM(m); */
void voltage_match_step(machine_model_t* m, const regression_t* r, int32_t w_q30, int32_t share_q30);

/*@ requires \valid(s) && \valid_read(r); assigns *s \from *s, *r, mean_q30, share_q30;
    ensures WITHIN(s->mismatch_q30, 53687091); */
void sensor_match_step(sensor_match_t* s, const regression_t* r, int32_t mean_q30, int32_t share_q30);

/*@ requires \valid(s) && \valid_read(in); assigns *s, \result \from *s, *in, periods;
    ensures FROM_TO(\result, 2097152, 134217728) && FROM_TO(s->ratio_q24, 2097152, 134217728);
    ensures FROM_TO(s->phase, 0, 2); */
int32_t inertia_match_step(inertia_match_t* s, const inertia_seen_t* in, int32_t periods);

// Estimators

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in); assigns *s, \result \from *s, *c, indirect:*in;
    ensures OF_OUTPUT(\result) && OF_REGRESSION(s->regression) && WITHIN(s->observer.speed_bpp, SPEED_END); */
estimator_output_t avv_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in); assigns *s, \result \from *s, *c, indirect:*in;
    ensures OF_OUTPUT(\result) && WITHIN(s->speed_bpp, SPEED_END) && FROM_TO(s->waited, 0, 10); */
estimator_output_t zvv_step(zvv_t* s, const zvv_config_t* c, const estimator_input_t* in, int32_t id_reference_q20);

/*@ requires \valid_read(in) && \valid(deviation_q20);
    assigns *deviation_q20, \result \from *deviation_q20, indirect:*in, angle_bam, speed_bpp; ensures FLAG(\result); */
bool zvv_deviation_q20(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, int32_t* deviation_q20);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in); assigns *s, \result \from *s, *c, indirect:*in;
    ensures OF_OUTPUT(\result) && OF_REGRESSION(s->regression) && WITHIN(s->speed_bpp, SPEED_END);
    ensures FLAG(s->load_is_new) && FLAG(s->leaned) && FLAG(s->is_sensitive) && FLAG(s->cogging.active);
    ensures FROM_TO(s->p_aa, 16, CURRENT_END) && FROM_TO(s->p_ss, 16, CURRENT_END) && FROM_TO(s->p_ll, 16, CURRENT_END);
    ensures FROM_TO(s->gathered.periods, 0, 12) && FROM_TO(s->cogging.known_q30, 0, 1073741824); */
estimator_output_t deviation_observer_step(deviation_observer_t* s, const deviation_observer_config_t* c,
                                           const estimator_input_t* in);

/*@ requires \valid(s) && \valid_read(c); assigns s->cogging, s->load_accel_q8 \from *s, *c;
    ensures FLAG(s->cogging.active) && FROM_TO(s->cogging.known_q30, 0, 1073741824); */
void deviation_observer_learn(deviation_observer_t* s, const deviation_observer_config_t* c);

/*@ requires \valid(s) && \valid(residual_q20) && \valid(span_ticks) && \valid(periods);
    assigns s->left, *residual_q20, *span_ticks, *periods, \result
            \from s->left, *residual_q20, *span_ticks, *periods;
    ensures FLAG(\result); ensures \initialized(residual_q20) && \initialized(span_ticks) && \initialized(periods);
    ensures FROM_TO(*span_ticks, 0, 240000) && FROM_TO(*periods, 0, 16); */
bool deviation_observer_take_left(deviation_observer_t* s, dq_t* residual_q20, int32_t* span_ticks, int32_t* periods);

/*@ requires \valid_read(windows + (0 .. count - 1)) && \valid(frames + (0 .. count - 1)) && count <= 3;
    assigns frames[0 .. 2] \from windows[0 .. 2], count, middle_bam, w_q30;
    ensures \initialized(frames + (0 .. 2));
    ensures OF_FRAME(frames[0]) && OF_FRAME(frames[1]) && OF_FRAME(frames[2]); */
void deviation_frames(const estimator_window_t windows[], uint16_t count, uint32_t middle_bam, int32_t w_q30,
                      estimator_frame_t frames[]);

/*@ requires \valid_read(m) && \valid_read(w); assigns \result \from *m, *w, angle_bam, speed_bpp;
    ensures WITHIN(\result.voltage_q16.d, 131072000) && WITHIN(\result.voltage_q16.q, 131072000);
    ensures WITHIN(\result.current_q20.d, CURRENT_END) && WITHIN(\result.current_q20.q, CURRENT_END); */
deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(in) && \valid_read(period);
    assigns *s, \result \from *s, *c, indirect:*in, *period;
    ensures OF_OUTPUT(\result) && WITHIN(s->observer.speed_bpp, SPEED_END); */
estimator_output_t flux_observer_step(flux_observer_t* s, const flux_observer_config_t* c, const estimator_input_t* in,
                                      const flux_period_t* period);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(m); assigns *s \from *c, *m;
    ensures WITHIN(s->observer.speed_bpp, SPEED_END); */
void flux_observer_reset(flux_observer_t* s, const flux_observer_config_t* c, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(now); assigns *s \from *s, *now, current_q20;
    ensures WITHIN(s->observer.speed_bpp, SPEED_END); */
void flux_observer_preset(flux_observer_t* s, const estimator_output_t* now, dq_t current_q20);

/*@ requires \valid(s); assigns *s \from *s; ensures WITHIN(s->observer.speed_bpp, SPEED_END); */
void flux_observer_keep(flux_observer_t* s);

/*@ requires \valid(seen) && \valid_read(m) && \valid_read(windows + (0 .. count - 1));
    assigns seen->residual_q20, seen->span_ticks \from *m, windows[0 .. 2], count, angle_bam;
    ensures \initialized(&seen->residual_q20.d) && \initialized(&seen->residual_q20.q);
    ensures \initialized(&seen->span_ticks) && FROM_TO(seen->span_ticks, 0, 30000); */
void synchronism_look(synchronism_seen_t* seen, const machine_model_t* m, const estimator_window_t windows[],
                      uint16_t count, uint32_t angle_bam);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(m) && \valid_read(seen);
    assigns *s, \result \from *s, *c, *m, *seen, apart_bam; ensures FLAG(\result) && FROM_TO(s->limit_q16, 0, 32768000);
 */
bool synchronism_judge(synchronism_t* s, const synchronism_config_t* c, const machine_model_t* m,
                       const synchronism_seen_t* seen, int32_t apart_bam);

// The start and the commissioning

/*@ requires \valid(s); assigns *s, \result \from *s, angle_bam;
    ensures WITHIN(\result, CURRENT_END) && FROM_TO(s->result, 0, 3); */
int32_t polarity_step(polarity_t* s, uint32_t angle_bam);

/*@ requires \valid(s) && \valid_read(r) && \valid_read(m); assigns *s, \result \from *s, *r, *m;
    ensures WITHIN(\result, CURRENT_END) && FROM_TO(s->result, 0, 3); */
int32_t saturation_step(saturation_t* s, const regression_t* r, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(m) && \valid_read(slopes); assigns *s \from *m, *slopes, current_q20;
    ensures FROM_TO(s->result, 0, 3); */
void saturation_begin(saturation_t* s, const machine_model_t* m, const saturation_slopes_t* slopes,
                      int32_t current_q20);

/*@ requires \valid_read(s) && \valid_read(m); assigns \result \from *s, *m; */
int32_t saturation_resistance_q24(const saturation_t* s, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(r); assigns *s \from *s, *r; */
void axis_add(axis_t* s, const regression_t* r);

/*@ requires \valid_read(s) && \valid_read(m); assigns \result \from *s, *m;
    ensures WITHIN(\result.angle_bam, 1073741824) && WITHIN(\result.mean_q30, ADMITTANCE_END);
    ensures WITHIN(\result.half_q30, ADMITTANCE_END); */
axis_result_t axis_evaluate(const axis_t* s, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(m) && \valid_read(w); assigns *s \from *s, *m, *w, tick;
    ensures FROM_TO(s->windows, 0, 30); */
void flying_add(flying_pulse_t* s, const machine_model_t* m, const estimator_window_t* w, int32_t tick);

/*@ requires \valid_read(s) && \valid_read(m); assigns \result \from *s, *m;
    ensures FROM_TO(\result.size_q16, 0, 2147483647); */
flying_emf_t flying_evaluate(const flying_pulse_t* s, const machine_model_t* m);

/*@ requires \valid_read(e) && \valid_read(m); assigns \result \from *e, *m, least, most;
    ensures least <= \result <= most; */
int32_t flying_pause(const flying_emf_t* e, const machine_model_t* m, int32_t least, int32_t most);

/*@ requires \valid_read(first) && \valid_read(second) && \valid_read(m) && \valid(rotor);
    assigns *rotor, \result \from *rotor, *first, *second, *m; ensures FLAG(\result);
    ensures \initialized(rotor) && WITHIN(rotor->speed_bpp, SPEED_END); */
bool flying_resolve(const flying_emf_t* first, const flying_emf_t* second, const machine_model_t* m,
                    flying_rotor_t* rotor);

/*@ requires \valid(s) && \valid_read(m) && \valid_read(seen); assigns *s, \result \from *s, *m, *seen;
    ensures FROM_TO(\result, 0, 2); */
emf_sign_result_t emf_sign_step(emf_sign_t* s, const machine_model_t* m, const emf_sign_seen_t* seen);

/*@ requires \valid(s) && \valid_read(first) && \valid_read(second); assigns *s \from *s, *first, *second;
    ensures FROM_TO(s->count, 0, 2147483647); */
void tensor_add(tensor_sums_t* s, const deviation_t* first, const deviation_t* second);

/*@ requires \valid(s) && \valid_read(c); assigns *s, \result \from *s, *c, voltage_q16, seen_bam, seen_bpp;
    ensures WITHIN(s->speed_bpp, 683565276) && FROM_TO(s->tick, 0, 65536) && FLAG(s->backward);
    ensures FROM_TO(s->current_q20, 0, 104857600) && FROM_TO(\result, 0, 2); */
if_start_result_t if_start_step(if_start_t* s, const if_start_config_t* c, dq_t voltage_q16, uint32_t seen_bam,
                                int32_t seen_bpp);

// Samples

/*@ requires \valid_read(c) && \valid_read(sums) && \valid(w);
    assigns w->slope_q20, w->current_q20 \from *c, *sums, w->span_ticks;
    ensures WITHIN(w->slope_q20.alpha, 1073741824) && WITHIN(w->slope_q20.beta, 1073741824);
    ensures WITHIN(w->current_q20.alpha, 268435456) && WITHIN(w->current_q20.beta, 268435456); */
void slopes_evaluate(const slopes_scale_t* c, const slopes_sums_t* sums, estimator_window_t* w);

// Control and modulation

/*@ requires \valid(s) && \valid_read(in); assigns *s, \result \from *s, law, *in;
    ensures in->lowest_q20 <= \result <= in->highest_q20; */
int32_t speed_controller_step(speed_controller_t* s, speed_law_t law, const speed_controller_input_t* in);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(m); assigns *s, \result \from *s, *c, *m; ensures FLAG(\result);
 */
bool speed_controller_init(speed_controller_t* s, const speed_controller_config_t* c, const machine_model_t* m);

/*@ requires \valid(s) && \valid_read(c) && \valid(pulses);
    assigns *s, *pulses, \result \from *s, *c, excitation, voltage_q16, link_q16;
    ensures FLAG(s->is_alternating) && FLAG(s->alternating.pair_first) && FROM_TO(s->alternating.leg, 0, 2);
    ensures FLAG(\result.limited) && WITHIN(\result.realised_q16.alpha, 131072000) && WITHIN(\result.realised_q16.beta,
   131072000); ensures \initialized(&pulses->at[0 .. 5]) && \initialized(&pulses->order) && OF_EDGES(pulses->at); */
modulator_result_t modulator_step(modulator_t* s, const modulator_config_t* c, excitation_t excitation,
                                  ab_t voltage_q16, int32_t link_q16, svpwm_pulses_t* pulses);

/*@ requires \valid_read(c) && \valid_read(sampling) && \valid_read(carried) && \valid(pattern) && \valid(command);
    assigns pattern->windows[0 .. 2], pattern->window_count, *command \from *c, *sampling, *carried, *pattern;
    ensures \initialized(&pattern->window_count) && \initialized(&pattern->windows[0 .. 2]);
    ensures FROM_TO(pattern->window_count, 0, 3);
    ensures OF_WINDOW(pattern->windows[0]) && OF_WINDOW(pattern->windows[1]) && OF_WINDOW(pattern->windows[2]);
    ensures \initialized(&command->at[0 .. 5]) && \initialized(&command->order) && OF_EDGES(command->at); */
void svpwm_send(const dead_time_config_t* c, const sampling_config_t* sampling, const svpwm_carried_t* carried,
                svpwm_pattern_t* pattern, svpwm_pulses_t* command);

/*@ requires \valid_read(p); assigns \result \from *p, link_q16;
    ensures WITHIN(\result.alpha, 131072000) && WITHIN(\result.beta, 131072000); */
ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16);

/*@ requires \valid_read(p) && count <= 3 && (count == 0 || \valid_read(ticks + (0 .. count - 1)));
    assigns \result \from *p, ticks[0 .. 2], count, link_q16;
    ensures WITHIN(\result.alpha, 1073741824) && WITHIN(\result.beta, 1073741824); */
ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, const int16_t ticks[], uint16_t count, int32_t link_q16);

#endif

// What the model of the machine and the controllers promise, in ACSL: the part control reads their code and shows it,
// the part interrupt takes it in the code's place.

#ifndef STILLSPIN_TESTS_PROVE_CONTROL_RANGES_H
#define STILLSPIN_TESTS_PROVE_CONTROL_RANGES_H

#include "control/if_start.h"
#include "control/machine_model.h"
#include "control/rise.h"
#include "control/speed_controller.h"
#include "tests/prove/ends.h"
#include "tests/prove/qmath_ranges.h"

#define OF_TURN(m)                                                                                           \
  (INVERSE((m)->per_yq) && WITHIN((m)->k_dd_q24, TILT_END_Q24 / 2) && WITHIN((m)->k_dq_q24, TILT_END_Q24) && \
   WITHIN((m)->k_qd_q24, TILT_END_Q24) && VECTOR_DQ((m)->k0_q20, K0_END_Q20))
#define OF_ALONG(y_q30) FROM_TO(y_q30, 0, Y_END_Q30)
#define OF_RESISTANCE(m) FROM_TO((m)->rs_q24, -RS_NOMINAL_MAX_Q24 / 2, 2 * RS_NOMINAL_MAX_Q24)

/*@ requires \valid(m) && WITHIN(iq_q20, CURRENT_MAX_Q20);
    assigns m->iq_q20, m->rs_q24, m->yd_q30, m->yq_q30, m->ydq_q30, m->per_yq, m->k_dd_q24, m->k_dq_q24, m->k_qd_q24,
            m->k0_q20, m->psi_d_q16, m->psi_q_q16 \from *m, iq_q20;
    ensures OF_RESISTANCE(m) && WITHIN(m->iq_q20, CURRENT_MAX_Q20);
    ensures OF_ALONG(m->yd_q30); ensures OF_ALONG(m->yq_q30); ensures WITHIN(m->ydq_q30, Y_CROSS_END_Q30);
    ensures OF_TURN(m); */
void machine_model_move(machine_model_t* m, int32_t iq_q20);

/*@ requires \valid(m) && WITHIN(iq_q20, CURRENT_MAX_Q20);
    assigns m->iq_q20, m->rs_q24, m->yd_q30, m->yq_q30, m->ydq_q30, m->k0_q20, m->psi_d_q16, m->psi_q_q16
            \from *m, iq_q20;
    ensures OF_RESISTANCE(m) && WITHIN(m->iq_q20, CURRENT_MAX_Q20);
    ensures OF_ALONG(m->yd_q30); ensures OF_ALONG(m->yq_q30); ensures WITHIN(m->ydq_q30, Y_CROSS_END_Q30);
    ensures VECTOR_DQ(m->k0_q20, K0_END_Q20); */
void machine_model_follow(machine_model_t* m, int32_t iq_q20);

/*@ requires \valid(m); assigns m->per_yq, m->k_dd_q24, m->k_dq_q24, m->k_qd_q24, m->k0_q20 \from *m;
    ensures OF_TURN(m); */
void machine_model_renew_sensitivity(machine_model_t* m);

/*@ assigns \result \from x, from, to; ensures FROM_TO(\result, 0, RISE_ONE_Q30); */
int32_t rise_q30(int32_t x, int32_t from, int32_t to);

/*@ requires \valid(s) && \valid_read(in) && FROM_TO(s->nominal.share_q30, 0, 1073741824);
    requires WITHIN(in->lowest_q20, CURRENT_MAX_Q20) && WITHIN(in->highest_q20, CURRENT_MAX_Q20);
    assigns s->current_q20, s->integral_q20, \result \from *s, law, *in;
    ensures WITHIN(\result, CURRENT_MAX_Q20); */
int32_t speed_controller_step(speed_controller_t* s, speed_law_t law, const speed_controller_input_t* in);

/*@ requires \valid(s) && \valid_read(c) && \valid_read(m) && FROM_TO(s->nominal.share_q30, 0, 1073741824);
    assigns *s, \result \from *s, *c, *m;
    ensures FLAG(\result); ensures FROM_TO(s->nominal.share_q30, 0, 1073741824); */
bool speed_controller_init(speed_controller_t* s, const speed_controller_config_t* c, const machine_model_t* m);

// What the current controller may command; 200 A through 50 ohm, and as much for turning; the mean of what that leaves,
// so that its sign may change.
#define TURN_COMMAND_END_Q16 268435456L
#define TURN_OWN_END_Q16 655360000L
#define TURN_EMF_END_Q16 923795456L

/*@ requires \valid(s) && \valid_read(c) && VECTOR_DQ(s->own_q16, TURN_OWN_END_Q16);
    requires VECTOR_DQ(voltage_q16, TURN_COMMAND_END_Q16);
    assigns *s, \result \from *s, *c, voltage_q16, seen_bam, seen_bpp;
    ensures VECTOR_DQ(s->mean_q16, TURN_EMF_END_Q16) && VECTOR_DQ(s->own_q16, TURN_OWN_END_Q16);
    ensures WITHIN(s->speed_bpp, TURN_MAX_BPP) && FROM_TO(s->tick, 0, 65536) && FLAG(s->took_over);
    ensures WITHIN(s->end_bpp, TURN_MAX_BPP) && FROM_TO(s->sign, -1, 1) && FROM_TO(s->waited, -51, 100001);
    ensures FROM_TO(s->current_q20, 0, 200 * AMPERES_Q20); ensures FROM_TO(\result, 0, 2); */
if_start_result_t if_start_step(if_start_t* s, const if_start_config_t* c, dq_t voltage_q16, uint32_t seen_bam,
                                int32_t seen_bpp);

#endif

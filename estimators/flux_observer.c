#include "estimators/flux_observer.h"

#define CUTOFF_LEAST_Q30 107374L
#define CUTOFF_MOST_Q30 16106127L       // 150 rad/s at 10 kHz
#define COMPENSATED_MOST_Q30 35433480L  // 330 rad/s, of which an offset decays with 3/8
#define RISE_Q30 5369L                  // 500 rad/s in a second
#define BANDWIDTH_MOST_Q30 107374182L
#define FOLLOW_Q30 268435456L  // k = 1/4: the length follows with w_c/4, offsets decay with 3/8 w_c
#define PLACES 32u             // 3.2 ms: a period and more of the sixth harmonic from 780 rpm on, with four pole pairs
#define PLACE_STEP 13u

static stator_flux_config_t form_of(const flux_observer_config_t* c) {
  const stator_flux_form_t read = c->is_plain ? STATOR_FLUX_PLAIN : STATOR_FLUX_COMPENSATED;
  const bool is_bare = c->method == FLUX_PP02 && !c->is_printed;
  const stator_flux_config_t form = {is_bare ? STATOR_FLUX_BARE : read, c->cutoff_q30, FOLLOW_Q30};
  return form;
}

bool flux_observer_config_valid(const flux_observer_config_t* c, const machine_model_t* m) {
  flux_machine_t trial;
  return c->method <= FLUX_ACTIVE && q_in_range(c->bandwidth_q30, CUTOFF_LEAST_Q30, BANDWIDTH_MOST_Q30) &&
         c->adaptation_periods >= 1u && c->adaptation_periods <= 1000u &&
         q_in_range(c->cutoff_q30, CUTOFF_LEAST_Q30, CUTOFF_MOST_Q30) && flux_adaptation_config_valid(&c->adaptation) &&
         flux_machine_init(&trial, m);
}

void flux_observer_reset(flux_observer_t* s, const flux_observer_config_t* c, const machine_model_t* m) {
  static const flux_observer_t empty = {.pause = 0u};
  *s = empty;
  s->form = form_of(c);
  s->pause = c->adaptation_periods;
  flux_adaptation_reset(&s->adaptation);
  flux_machine_move(&s->machine, m, &s->adaptation.shares);
}

// By Fig. 5 it rises slowly from where it was set back to: what has just changed the flux's length would be forgotten.
static void place_cutoff(flux_observer_t* s, const flux_observer_config_t* c) {
  const int32_t half_q30 = q_shr(q_abs_sat(machine_speed_rad_q30(s->observer.speed_bpp)), 1);
  int32_t most_q30 = 0;
  if (s->form.form == STATOR_FLUX_BARE) most_q30 = CUTOFF_MOST_Q30;
  if (s->form.form == STATOR_FLUX_COMPENSATED && !c->is_printed) {
    most_q30 = q_min(s->form.cutoff_q30, COMPENSATED_MOST_Q30 - RISE_Q30) + RISE_Q30;
  }
  s->form.cutoff_q30 = q_max(q_min(half_q30, most_q30), c->cutoff_q30);
}

void flux_observer_keep(flux_observer_t* s) { s->form.cutoff_q30 = 0; }

void flux_observer_preset(flux_observer_t* s, const estimator_output_t* now, dq_t current_q20) {
  const flux_machine_t* const f = &s->machine;
  // (3), per unit and then as flux/T.
  const int32_t d_q24 = q_add_sat(FLUX_ONE_Q24, q_mul_sat(current_q20.d, f->ld_per_psi_q30, 26));
  const int32_t q_q24 = q_mul_sat(current_q20.q, f->lq_per_psi_q30, 26);
  const dq_t flux_q16 = {q_limit(q_mul_sat(f->psi_q16, d_q24, 24), f->bound_q16),
                         q_limit(q_mul_sat(f->psi_q16, q_q24, 24), f->bound_q16)};
  flux_observer_keep(s);
  s->flux_q16 = frame_fixed(flux_q16, now->angle_bam);
  stator_flux_preset(&s->flux, s->flux_q16);
  tracking_observer_preset(&s->observer, now->angle_bam, now->speed_bpp, now->load_accel_q8);
  s->current_q20 = frame_fixed(current_q20, now->angle_bam);
}

// A phase without current makes its voltage itself, within what dead time and drops leave open, and nobody measures it:
// along that phase the EMF is what the flux makes at the speed that is observed. From the speed on at which the magnet
// is learnt it stands out of that.
static void expect_unseen(const flux_observer_t* s, const flux_observer_config_t* f, ab_t* emf_q16) {
  if (s->form.form == STATOR_FLUX_PLAIN || f->is_printed) return;
  if (q_abs_sat(s->observer.speed_bpp) >= f->adaptation.lowest_bpp) return;
  const abc_t current_q20 = frame_inverse_clarke(s->current_q20);
  const bool a = q_abs_sat(current_q20.a) < f->unknown_voltage_q20;
  const bool b = q_abs_sat(current_q20.b) < f->unknown_voltage_q20;
  const bool c = q_abs_sat(current_q20.c) < f->unknown_voltage_q20;
  if (!a && !b && !c) return;
  const int32_t turn_q30 = machine_speed_rad_q30(s->observer.speed_bpp);
  const ab_t expected_q16 = {q_mul_sat(s->flux_q16.beta, -turn_q30, 30), q_mul_sat(s->flux_q16.alpha, turn_q30, 30)};
  if (a) {
    emf_q16->alpha = expected_q16.alpha;
    return;
  }
  const ab_t quarter_q16 = {q_shr(expected_q16.alpha, 2) - q_shr(emf_q16->alpha, 2),
                            q_shr(expected_q16.beta, 2) - q_shr(emf_q16->beta, 2)};
  const abc_t missing_q16 = frame_inverse_clarke(quarter_q16);
  const int32_t along_q16 = b ? missing_q16.b : missing_q16.c;
  const int32_t across_q16 = q_mul_sat(along_q16, FRAME_SQRT3_HALF_Q30, 28);
  emf_q16->alpha = q_sub_sat(emf_q16->alpha, q_shl_sat(along_q16, 1));
  emf_q16->beta = b ? q_add_sat(emf_q16->beta, across_q16) : q_sub_sat(emf_q16->beta, across_q16);
}

static void integrate(flux_observer_t* s, const flux_observer_config_t* c, const machine_model_t* m,
                      const flux_period_t* p) {
  // Mean current of the period, as between its ends.
  const int32_t alpha_q20 = q_shr(s->current_q20.alpha + p->current_q20.alpha, 1);
  const int32_t beta_q20 = q_shr(s->current_q20.beta + p->current_q20.beta, 1);
  ab_t emf_q16 = {q_sub_sat(p->voltage_q16.alpha, q_mul_sat(m->rs_q24, alpha_q20, 28)),
                  q_sub_sat(p->voltage_q16.beta, q_mul_sat(m->rs_q24, beta_q20, 28))};
  s->current_q20 = p->current_q20;
  expect_unseen(s, c, &emf_q16);
  stator_flux_step(&s->flux, &s->form, emf_q16, s->observer.speed_bpp, s->machine.bound_q16);
}

static int32_t load_angle(const flux_observer_t* s, const flux_observer_config_t* c, dq_t reference_q20) {
  const flux_vectors_t* const v = &s->vectors;
  if (c->method == FLUX_CONV) return flux_load_angle_ft(v);
  const int32_t square_q24 =
      (c->method == FLUX_PP02) ? flux_reference_square_q24(&s->machine, reference_q20) : flux_square_q24(v);
  return flux_load_angle_dq(flux_currents_q24(&s->machine, v, square_q24));
}

// (34), which leads with the rotation: from the cut-off on it is none.
static uint32_t printed_lead(const flux_observer_t* s, const flux_observer_config_t* c) {
  const int32_t speed_q30 = machine_speed_rad_q30(s->observer.speed_bpp);
  const int32_t length_q30 = q_abs_sat(speed_q30);
  if (!c->is_printed || c->method != FLUX_PP02 || length_q30 >= c->cutoff_q30) return 0u;
  const uint32_t lead_bam = q_atan2(c->cutoff_q30, length_q30);
  return (speed_q30 < 0) ? 0u - lead_bam : lead_bam;
}

static uint32_t rotor_angle(flux_observer_t* s, const flux_observer_config_t* c, dq_t reference_q20) {
  const uint32_t flux_bam = flux_stator_angle(&s->vectors);
  if (c->method == FLUX_ACTIVE) {
    const uint32_t active_bam = flux_active_angle(&s->vectors);
    s->load_angle_bam = angle_diff_bam(flux_bam, active_bam);
    return active_bam;
  }
  s->load_angle_bam = load_angle(s, c, reference_q20);
  return flux_bam - (uint32_t)s->load_angle_bam - printed_lead(s, c);
}

// Not at even intervals: the harmonics of the EMF stand still to who looks once in eight of their periods, as 10 ms are
// at 2000 rpm on four pole pairs, and would be taken for flux. Places in an order that no speed has.
static uint16_t next_pause(flux_observer_t* s, const flux_observer_config_t* c) {
  if (c->adaptation_periods <= PLACES) return c->adaptation_periods;
  const uint16_t last = s->place;
  s->place = (uint16_t)((last + PLACE_STEP) % PLACES);
  return (uint16_t)(c->adaptation_periods + s->place - last);
}

estimator_output_t flux_observer_step(flux_observer_t* s, const flux_observer_config_t* c, const estimator_input_t* in,
                                      const flux_period_t* period) {
  tracking_observer_t* const o = &s->observer;
  place_cutoff(s, c);
  integrate(s, c, in->model, period);
  tracking_observer_predict(o, in->torque_accel_q8);
  s->flux_q16 = stator_flux_q16(&s->flux, &s->form);
  s->vectors = flux_vectors(&s->machine, s->flux_q16, period->current_q20);
  s->error_bam = angle_diff_bam(rotor_angle(s, c, period->reference_q20), o->angle_bam);
  tracking_observer_correct(o, s->error_bam, c->bandwidth_q30);
  if (s->pause > 1u) {
    s->pause--;
  } else if (!period->is_full) {
    s->pause = next_pause(s, c);
    flux_adaptation_step(&s->adaptation, &c->adaptation, in->model, &s->machine, &s->vectors, period->measured_q20,
                         o->speed_bpp);
  }
  const estimator_output_t out = {o->angle_bam, o->speed_bpp, o->load_accel_q8,
                                  (s->form.cutoff_q30 > c->cutoff_q30) ? INT16_MAX : 0};
  return out;
}

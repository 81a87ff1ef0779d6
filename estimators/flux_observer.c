#include "estimators/flux_observer.h"

#define CUTOFF_LEAST_Q30 107374L
#define CUTOFF_MOST_Q30 53687091L
#define BANDWIDTH_MOST_Q30 107374182L
#define BARE_SHARE 4         // w_c is a quarter of the speed,
#define COMPENSATED_SHARE 2  // or half of it: offsets decay with w/4 and w/8
#define PLACES 32u           // 3.2 ms: a period and more of the sixth harmonic from 780 rpm on, with four pole pairs
#define PLACE_STEP 13u
#define FOLLOW_Q30 536870912L  // k = 1/2: the length follows with w_c/2, offsets decay with w_c/4

static stator_flux_config_t form_of(const flux_observer_config_t* c) {
  const stator_flux_config_t form = {(c->method == FLUX_PP02) ? STATOR_FLUX_BARE : STATOR_FLUX_COMPENSATED,
                                     c->cutoff_q30, FOLLOW_Q30};
  return form;
}

bool flux_observer_config_valid(const flux_observer_config_t* c, const machine_model_t* m) {
  const stator_flux_config_t form = form_of(c);
  flux_machine_t trial;
  return c->method <= FLUX_ACTIVE && q_in_range(c->bandwidth_q30, CUTOFF_LEAST_Q30, BANDWIDTH_MOST_Q30) &&
         c->adaptation_periods >= 1u && c->adaptation_periods <= 1000u && stator_flux_config_valid(&form) &&
         flux_adaptation_config_valid(&c->adaptation) && flux_machine_init(&trial, m);
}

void flux_observer_reset(flux_observer_t* s, const flux_observer_config_t* c, const machine_model_t* m) {
  static const flux_observer_t empty = {.pause = 0u};
  *s = empty;
  s->form = form_of(c);
  s->pause = c->adaptation_periods;
  flux_adaptation_reset(&s->adaptation);
  flux_machine_move(&s->machine, m, &s->adaptation.shares);
}

// w_c is a share of the speed, where that is more.
static void place_cutoff(flux_observer_t* s, const flux_observer_config_t* c) {
  const int32_t share = (s->form.form == STATOR_FLUX_BARE) ? BARE_SHARE : COMPENSATED_SHARE;
  const int32_t share_q30 = q_abs_sat(machine_speed_rad_q30(s->observer.speed_bpp)) / share;
  s->form.cutoff_q30 = q_clamp(share_q30, c->cutoff_q30, CUTOFF_MOST_Q30);
}

void flux_observer_preset(flux_observer_t* s, const flux_observer_config_t* c, const estimator_output_t* now,
                          dq_t current_q20) {
  const flux_machine_t* const f = &s->machine;
  // (3), per unit and then as flux/T.
  const int32_t d_q24 = q_add_sat(FLUX_ONE_Q24, q_mul_sat(current_q20.d, f->ld_per_psi_q30, 26));
  const int32_t q_q24 = q_mul_sat(current_q20.q, f->lq_per_psi_q30, 26);
  const dq_t flux_q16 = {q_clamp(q_mul_sat(f->psi_q16, d_q24, 24), -f->bound_q16, f->bound_q16),
                         q_clamp(q_mul_sat(f->psi_q16, q_q24, 24), -f->bound_q16, f->bound_q16)};
  s->form = form_of(c);
  stator_flux_preset(&s->flux, frame_fixed(flux_q16, now->angle_bam));
  tracking_observer_preset(&s->observer, now->angle_bam, now->speed_bpp, now->load_accel_q8);
  s->current_q20 = frame_fixed(current_q20, now->angle_bam);
  s->error_bam = 0;
}

static void integrate(flux_observer_t* s, const machine_model_t* m, const flux_period_t* p) {
  // Mean current of the period, as between its ends.
  const int32_t alpha_q20 = q_shr(s->current_q20.alpha + p->current_q20.alpha, 1);
  const int32_t beta_q20 = q_shr(s->current_q20.beta + p->current_q20.beta, 1);
  const ab_t emf_q16 = {q_sub_sat(p->voltage_q16.alpha, q_mul_sat(m->rs_q24, alpha_q20, 28)),
                        q_sub_sat(p->voltage_q16.beta, q_mul_sat(m->rs_q24, beta_q20, 28))};
  s->current_q20 = p->current_q20;
  stator_flux_step(&s->flux, &s->form, emf_q16, s->observer.speed_bpp, s->machine.bound_q16);
}

static int32_t load_angle(const flux_observer_t* s, const flux_observer_config_t* c, dq_t reference_q20) {
  const flux_vectors_t* const v = &s->vectors;
  if (c->method == FLUX_CONV) return flux_load_angle_ft(v);
  const int32_t square_q24 =
      (c->method == FLUX_PP02) ? flux_reference_square_q24(&s->machine, reference_q20) : flux_square_q24(v);
  return flux_load_angle_dq(flux_currents_q24(&s->machine, v, square_q24));
}

static uint32_t rotor_angle(flux_observer_t* s, const flux_observer_config_t* c, dq_t reference_q20) {
  const uint32_t flux_bam = flux_stator_angle(&s->vectors);
  if (c->method == FLUX_ACTIVE) {
    const uint32_t active_bam = flux_active_angle(&s->vectors);
    s->load_angle_bam = angle_diff_bam(flux_bam, active_bam);
    return active_bam;
  }
  s->load_angle_bam = load_angle(s, c, reference_q20);
  return flux_bam - (uint32_t)s->load_angle_bam;
}

// 0 up to half the cut-off, all from the cut-off on.
static int32_t quality_q15(const flux_observer_config_t* c, int32_t w_q30) {
  const int32_t half = c->cutoff_q30 / 2;
  const int32_t above_q30 = q_abs_sat(w_q30) - half;
  if (above_q30 <= 0) return 0;
  return (above_q30 < half) ? q_div(above_q30, half, 15) : 32767;
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
  integrate(s, in->model, period);
  tracking_observer_predict(o, in->torque_accel_q8);
  const ab_t flux_q16 = stator_flux_q16(&s->flux, &s->form);
  s->vectors = flux_vectors(&s->machine, flux_q16, period->current_q20);
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
                                  quality_q15(c, machine_speed_rad_q30(o->speed_bpp))};
  return out;
}

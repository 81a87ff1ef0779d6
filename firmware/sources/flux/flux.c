#include "firmware/sources/flux/flux.h"

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/sources/observer/observer.h"
#include "hal/hal_profile.h"
#include "hal/qmath/qcall.h"
#include "svpwm/ripple.h"

#define ADAPTATION_PERIODS 100u          // a tenth of the speed control's rate
#define INDUCTANCE_SHARE_Q30 107374182L  // 0.1: 100 ms
#define MAGNET_SHARE_Q30 53687091L       // 0.05: 200 ms
#define CURRENT_LEAST_Q24 838861L        // the torque current makes a twentieth of the magnet's flux
#define LEARNING_BPP 27342611L           // 400 rad/s: the magnet's flux is learnt from there on
#define OBSERVABILITY_SHIFT 4            // 16 ms: the torque current's noise stays out of i_d
#define OBSERVABLE_CURRENTS 3  // times the current whose sign is certain: i_d without torque where the flux sees
#define LEAST_BAND_Q20 10486L  // 0.01 A
#define LEARN_INDUCTANCE 1
#define LEARN_MAGNET 2
#define PAPER_LOW_PASS 1
#define PAPER_PRINT 2

flux_observer_t flux_observer;
flux_observer_config_t flux_config;

int32_t flux_observability_q20;

static flux_observer_config_t made;

void flux_reset(void) {
  flux_observability_q20 = 0;
  flux_observer.load_angle_bam = 0;
  flux_observer.machine.psi_q16 = 0;
}

// That has the shaft, or looks on; below zero without one. No other source has variants.
static int32_t method(void) {
  return q_max(position_source_variants[parameters.position_source], parameters.flux_beside) - 1;
}

// Half of the band is for what the ripple at an edge is wrong by, and the flux has centred pulses without any.
static void narrow_band(dead_time_config_t* c) {
  const int32_t band_q20 = q_max(q_shr(c->band_q20, 1), LEAST_BAND_Q20);
  c->edge_band_q20 -= c->band_q20 - band_q20;
  c->band_q20 = band_q20;
  dead_time_design(c);
}

static packed_text_t make(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  if (p->flux_high <= p->flux_low) return SAY_flux_high_must_be_above_flux_low;
  if (p->flux_beside > 0 && !drive_source_selected_has(SOURCE_MEASURES)) return SAY_flux_beside_needs_position_source_0;
  const int32_t selected = method();
  const bool is_selected = selected >= 0;
  if (is_selected) narrow_band(&c->dead_time);
  flux_observer_config_t* const f = &made;
  f->method = (flux_method_t)(is_selected ? selected : FLUX_CONV);
  f->cutoff_q30 = qc_mul(p->flux_cutoff, CONFIG_PER_PERIOD_Q20, 20);
  f->bandwidth_q30 = qc_mul(p->flux_bandwidth, CONFIG_PER_PERIOD_Q20, 20);
  f->is_plain = (p->flux_plain & PAPER_LOW_PASS) != 0;
  f->is_printed = (p->flux_plain & PAPER_PRINT) != 0;
  // Without dead time every voltage is known.
  f->unknown_voltage_q20 = (c->dead_time.turn_on_ticks > 0) ? c->dead_time.band_q20 : 0;
  f->adaptation_periods = ADAPTATION_PERIODS;
  f->adaptation.saturation_q24 =
      ((p->flux_adapt & LEARN_INDUCTANCE) != 0) ? flux_adaptation_identify_q24(&c->nameplate) : 0;
  f->adaptation.inductance_q30 = INDUCTANCE_SHARE_Q30;
  f->adaptation.magnet_q30 = ((p->flux_adapt & LEARN_MAGNET) != 0) ? MAGNET_SHARE_Q30 : 0;
  f->adaptation.current_q24 = CURRENT_LEAST_Q24;
  f->adaptation.lowest_bpp = LEARNING_BPP;
  const bool fits = !is_selected || (blend_design(&c->blend, qc_mul_sat(p->flux_low, c->bpp_per_rpm_q8, 24),
                                                  qc_mul_sat(p->flux_high, c->bpp_per_rpm_q8, 24)) &&
                                     flux_observer_config_valid(f, &c->nameplate));
  return fits ? PACKED_NONE : SAY_the_machine_s_parameters_are_too_extreme;
}

static void take(void) { flux_config = made; }

const config_part_t flux_part = {make, take};

// The current at the end of the period: what was measured in the frame in use, that frame moved on.
static flux_period_t period_of(const drive_t* d, bool is_full) {
  const uint32_t end_bam = d->estimate.selected.angle_bam + (uint32_t)d->estimate.selected.speed_bpp;
  flux_period_t p;
  p.is_full = is_full;
  p.current_q20 = frame_fixed(d->estimate.measured_q20, end_bam);
  p.measured_q20 = d->estimate.measured_q20;
  p.reference_q20 = d->control.references.current_q20;
  if (d->flags.open_loop) {
    p.measured_q20 = position_seen(d, p.measured_q20);
    p.reference_q20 = position_seen(d, p.reference_q20);
  }
  const ab_t mean_q16 = svpwm_mean_q16(&modulation_sampled(&d->modulation)->pulses, d->samples.link_q16);
  const ab_t drop_q16 = dead_time_drop_q16(&d->config.dead_time, p.current_q20);
  p.voltage_q16.alpha = mean_q16.alpha - drop_q16.alpha;
  p.voltage_q16.beta = mean_q16.beta - drop_q16.beta;
  return p;
}

void flux_source_begin(const drive_t* d, bool keeps) {
  if (keeps) {
    flux_observer_keep(&flux_observer);
  } else {
    flux_observer_reset(&flux_observer, &flux_config, &d->estimate.model);
  }
}

static estimator_output_t step(const drive_t* d, const estimator_input_t* in, bool is_full) {
  const flux_period_t p = period_of(d, is_full);
  return flux_observer_step(&flux_observer, &flux_config, in, &p);
}

// The observer goes along, so that it is right when it is wanted again.
static void carry_observer(deviation_observer_t* o, const estimator_output_t* now) {
  o->angle_bam = now->angle_bam;
  o->speed_bpp = now->speed_bpp;
  o->load_accel_q8 = now->load_accel_q8;
}

estimator_output_t flux_source_alone(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in) {
  e->high = step(d, in, false);
  e->low = e->high;
  carry_observer(&e->observer, &e->high);
  return blend_step(&e->blend, &d->config.blend, &e->low, &e->high);
}

void flux_source_follow(const drive_t* d, const estimator_output_t* now) {
  flux_observer_preset(&flux_observer, now, d->estimate.measured_q20);
}

estimator_output_t flux_source_beside(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in,
                                      const estimator_output_t* low) {
  hal_profile_step(CYCLES_ESTIMATE_FLUX);
  e->high = *low;
  if (blend_is_low(&e->blend)) {
    flux_source_follow(d, low);
  } else {
    e->high = step(d, in, in->window_count > 0u);
  }
  return blend_step(&e->blend, &d->config.blend, low, &e->high);
}

estimator_output_t flux_source_look_on(const drive_t* d, const estimator_input_t* in, const estimator_output_t* truth) {
  if (q_abs_sat(truth->speed_bpp) >= d->config.blend.low_bpp) return step(d, in, false);
  flux_source_follow(d, truth);
  return *truth;
}

static excitation_t flux_excitation(const drive_t* d) {
  return position_observer_rests(d) ? EXCITATION_CENTRED : EXCITATION_ALTERNATING;
}

// While no current flows dead time hides the EMF: within a few volts the motor's voltage is its own, not the commanded
// one, and an integral of the commanded one does not see it. So some current always flows where the flux has the shaft,
// below the speed at which the magnet is learnt, and the EMF stands out of that.
static int32_t observability_current(const drive_t* d) {
  const drive_control_t* const c = &d->control;
  const int32_t least_q20 =
      q_min(OBSERVABLE_CURRENTS * d->config.dead_time.edge_band_q20, q_shr(c->current_limit_q20, 1));
  const bool unobservable =
      d->estimate.blend.share_q15 == 0 && q_abs_sat(d->estimate.selected.speed_bpp) < flux_config.adaptation.lowest_bpp;
  const int32_t missing_q20 = unobservable ? q_max(least_q20 - q_abs_sat(c->references.current_q20.q), 0) : 0;
  flux_observability_q20 = q_follow(flux_observability_q20, missing_q20, OBSERVABILITY_SHIFT);
  return -flux_observability_q20;
}

// The observer below the blend, the stator flux above, both between. There nothing is learnt of the windows, for want
// of time.
static estimator_output_t source_flux(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  in->regress = in->regress && (e->blend.region == BLEND_LOW || polarity_watch_is_awake(d));
  if (position_observer_rests(d)) return flux_source_alone(d, e, in);
  const estimator_output_t low = source_observer(d, e, in);
  return flux_source_beside(d, e, in, &low);
}

const position_source_t flux_source = {source_flux,
                                       flux_excitation,
                                       observability_current,
                                       flux_source_follow,
                                       flux_source_begin,
                                       NULL,
                                       SOURCE_OBSERVES | SOURCE_READS | SOURCE_HANDS_OVER | SOURCE_BLENDS,
                                       3};

// From the parameters, in the user's units, to the constants of every module.

#include "firmware/config/config.h"

#include "estimators/deviation.h"
#include "firmware/base/clear.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/mode/mode.h"
#include "hal/hal_adc.h"
#include "hal/qmath/qcall.h"

#define K0_MAX_Q20 1048576000L           // lambda/L of 1000 A
#define CRAWL_MAX_RPM 10                 // where cogging is learnt
#define PER_RELEASE_ANGLE_Q60 32941987L  // binary angle, Q8, to radian, over 0.2 rad
#define RELEASE_STEP_END_Q30 24159191L   // wc T with 225 rad/s
#define RELUCTANCE_END_Q16 1671168L      // 25.5 N m/A with the full scale, half of the largest current
#define EDGE_BAND_Q20 524288L            // half an ampere of ripple may be predicted wrong
#define RAD_PER_RPM_Q47 1473799531L      // 2 pi / 60 * 100 us
#define ONE_Q24 16777216L
#define MILLIHENRY_Q30 1099511628L  // mH (Q20) to H (Q30): 1.024

// Ticks of 10 ns from a time in us, Q16.
static int16_t ticks(int32_t time_q16) { return (int16_t)qc_mul(time_q16, 100, 16); }

// bandwidth (rad/s, Q8) * T, Q30.
static int32_t bandwidth_step_q30(int32_t bandwidth_q8) { return qc_mul(bandwidth_q8, CONFIG_PER_PERIOD_Q20, 20); }

// Share of an inductance (H, Q30) in percent (Q16).
static int32_t share_of(int32_t inductance_q30, int32_t percent_q16) {
  return qc_mul(inductance_q30, qc_mul(percent_q16, 10737418L, 16), 30);
}

static bool load_map(machine_model_t* m) {
  machine_map_parameters_t map;
  map.current_q20 = parameters.map_current;
  map.ldd_q30[0] = m->ld_q30;
  map.lqq_q30[0] = m->lq_q30;
  map.ldq_q30[0] = 0;
  for (uint16_t k = 0; k < MACHINE_MAP_SEGMENTS; k++) {
    map.ldd_q30[k + 1u] = share_of(m->ld_q30, parameter_at(PARAMETER_PLACE(ldd_1) + k));
    map.lqq_q30[k + 1u] = share_of(m->lq_q30, parameter_at(PARAMETER_PLACE(lqq_1) + k));
    map.ldq_q30[k + 1u] = qc_mul(parameter_at(PARAMETER_PLACE(ldq_1) + k), MILLIHENRY_Q30, 30);  // of mH
  }
  return machine_model_saturate(m, &map);
}

// What resistance and the fastest rotation take off the current's slope fits the look's format (deviation.h).
static bool damping_fits(const machine_model_t* m, int32_t k_q24) {
  const int32_t speed_q30 = qc_mul_sat(parameters.speed_limit * parameters.pole_pairs, RAD_PER_RPM_Q47, 25);
  return q_mul_hi(m->yd_q30, m->rs_q24) + q_mul_hi(speed_q30, k_q24) < DEVIATION_DAMPING_END_Q22;
}

// What the estimators make of a point of the map fits their formats: of h (machine_model.h) with the largest current
// that two sensors show together, twice their full scale.
static bool point_fits(const machine_model_t* m) {
  const int32_t k0_q20 = frame_largest(m->k0_q20.d, m->k0_q20.q);
  const int32_t either_q24 = frame_largest(m->k_dq_q24, m->k_qd_q24);
  const int32_t k_q24 = qc_add_sat(either_q24, 2 * qc_abs_sat(m->k_dd_q24));
  const int32_t h_speed_q20 = qc_add_sat(qc_mul_sat(k_q24, parameters.current_full_scale, 23), k0_q20);
  return k0_q20 <= K0_MAX_Q20 && h_speed_q20 < INT32_MAX && damping_fits(m, either_q24);
}

// So does the torque per ampere with that current, and the torque with it: the reluctance adds 51 N m/A to the 30 of
// the largest flux, times 400 A.
static bool torque_fits(const machine_model_t* m) {
  return q_shr(m->reluctance_q24, 12) * q_shr(parameters.current_full_scale, 16) > -RELUCTANCE_END_Q16;
}

static bool fits_formats(machine_model_t* m) {
  bool fits = torque_fits(m);
  for (int32_t k = 0; k < MACHINE_MAP_POINTS; k++) {
    machine_model_move(m, parameters.map_current / MACHINE_MAP_SEGMENTS * k);
    fits = fits && point_fits(m);
  }
  machine_model_move(m, 0);
  return fits;
}

static bool load_machine(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  machine_parameters_t m;
  m.rs_q24 = p->stator_resistance + p->device_resistance;
  m.ld_q30 = qc_mul(p->inductance_d, MILLIHENRY_Q30, 30);
  m.lq_q30 = qc_mul(p->inductance_q, MILLIHENRY_Q30, 30);
  m.flux_q28 = p->magnet_flux;
  m.inertia_q24 = p->inertia;
  m.pole_pairs = p->pole_pairs;
  m.period_us = DRIVE_PERIOD_US;
  if (!machine_model_init(&c->nameplate, &m) || !load_map(&c->nameplate) || !fits_formats(&c->nameplate)) return false;
  // rpm to binary angle per period: pole pairs / 60 s * T * 2^32 = 7158.2788 per pole pair.
  c->bpp_per_rpm_q8 = p->pole_pairs * 1832519L;
  c->rpm_per_bpp_q40 = q_div(16777216L, c->bpp_per_rpm_q8, 24);
  return true;
}

// Between two windows lie the edge and its settling at least; the window before must have been read by then.
#if SAMPLING_SETTLE_MIN_TICKS + HAL_ADC_BURST_TICKS < HAL_ADC_WINDOW_GAP_TICKS
#error "two windows follow each other faster than the converter is read"
#endif

// Two neighbouring active vectors are far from the mean voltage, and what the model's inductances lack would stand for
// an EMF: who asks for pulses of his own has the rest of the period looked at, too.
static uint16_t windows_wanted(const parameters_t* p) {
  return (p->excitation == EXCITATION_BY_SOURCE) ? drive_source_selected()->windows : SVPWM_WINDOWS;
}

static void load_modulation(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  c->modulator.pulse_ticks = ticks(p->pulse_time);
  c->modulator.extended.window_min_ticks = ticks(p->window_minimum);
  c->modulator.extended.window_max_ticks = ticks(p->window_maximum);
  c->modulator.extended.zero_ticks = ticks(p->zero_time);
  c->modulator.sampling.settle_ticks = ticks(p->settle_time);
  c->modulator.sampling.burst_ticks = HAL_ADC_BURST_TICKS;
  c->modulator.sampling.span_min_ticks = 300;
  c->modulator.sampling.last_tick = 9640;
  c->modulator.sampling.windows = windows_wanted(p);
  c->dead_time.turn_on_ticks = ticks(p->dead_time + p->turn_on_delay);
  c->dead_time.turn_off_ticks = ticks(p->turn_off_delay);
  c->dead_time.band_q20 = p->drop_band;
  c->dead_time.edge_band_q20 = EDGE_BAND_Q20 + c->dead_time.band_q20;
  c->dead_time.drop_q16 = p->device_drop;
  dead_time_design(&c->dead_time);
}

// How many times the speed up to which the saliency tells as much as the EMF has to be reached for all of the current,
// Q8. A window's slope changes per radian by (Yd - Yq) 2/3 U at a link U, and by Yq E with an EMF E. The observer
// weighs it by what its model has of both, the map's end; the machine beyond may have an Lqq below Ldd, whose share
// pulls the angle away. They balance where E = 2/3 U sqrt((l - 1)(1 - l')) with l = Lqq/Ldd there and l' at
// current_limit, and E is twice that, for a 1 - l' of up to four times. l' is not measured: a 1/Lqq that rises is taken
// to rise on with the square of the current.
static int16_t freed_by_q8(const machine_map_t* map, int32_t sixth_q30) {
  const machine_point_t* const end = &map->points[MACHINE_MAP_SEGMENTS];
  const int32_t yqq0_q30 = map->points[0].yqq_q30;
  const int32_t reach_q12 = q_div(parameters.current_limit, parameters.map_current, 12);
  const int32_t risen_q30 = q_max(end->yqq_q30 - yqq0_q30, 0);
  const int32_t gained_q30 = qc_mul_sat(risen_q30, qc_mul_sat(reach_q12, reach_q12, 16), 8);
  const int32_t above_q24 = q_max(q_div(end->ydd_q30, end->yqq_q30, 24) - ONE_Q24, 0);
  const int32_t below_q24 = q_max(ONE_Q24 - q_div(end->ydd_q30, qc_add_sat(yqq0_q30, gained_q30), 24), 0);
  const int32_t root_q24 = (int32_t)q_sqrt64((uint64_t)q_product(above_q24, below_q24));
  return (int16_t)(q_clamp(q_div(root_q24, sixth_q30, 14), 384, 24575) / 3 * 4);
}

// How stiffly a shaft is held while a brake opens: wc^2 is the acceleration by the largest current and the magnet, over
// 0.2 rad, so that a share of that torque turns every shaft below 225 rad/s as far, in electrical degrees. That much is
// what the current's own delay leaves. A shaft that is held more stiffly asks for amperes by what the observer errs.
static void load_release(drive_config_t* c) {
  const int32_t most_q16 = qc_mul_sat(c->nameplate.torque_q24, parameters.current_limit, 28);
  const int32_t accel_q8 = qc_mul_sat(c->nameplate.accel_q12, most_q16, 20);
  const uint64_t square_q60 = (uint64_t)q_product(accel_q8, PER_RELEASE_ANGLE_Q60);
  c->release_step_q30 = q_min((int32_t)q_sqrt64(square_q60), RELEASE_STEP_END_Q30);
}

static bool load_control(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  c->speed.friction_q24 = p->friction;
  c->speed.inertia_q24 = p->inertia;
  c->speed.step_periods = DRIVE_PERIODS_PER_MS;
  c->speed.alpha_q8 = q_shr_round(p->speed_alpha, 6);
  c->speed.trajectory_ms_q8 = p->speed_trajectory;
  c->speed.pi_bandwidth_q8 = p->speed_pi_bandwidth;
  c->speed.pi_damping_q12 = p->speed_pi_damping;
  // B (Q24, N m s) * rpm per bpp (Q40) * 2 pi / 60.
  c->friction_per_bpp_q40 = qc_mul_sat(qc_mul_sat(p->friction, c->rpm_per_bpp_q40, 24), 112442659L, 30);
  c->ramp_step_bpp = qc_mul_sat(p->speed_ramp, c->bpp_per_rpm_q8, 16) / 1000;
  // A sixth of the saliency (Lq - Ld)/(Lq + Ld), over the flux: at saliency_current at least an eighth of it is left.
  const int32_t sixth_q30 = q_div((p->inductance_q - p->inductance_d) / 6, p->inductance_q + p->inductance_d, 30);
  c->salient_bpp_q4 = qc_mul_sat(q_div(sixth_q30, c->nameplate.emf_q16, 20), ANGLE_BAM_PER_RAD, 30);
  c->freed_by_q8 = freed_by_q8(&c->nameplate.map, sixth_q30);
  c->salient_q20 = p->saliency_current;
  if (p->saliency_current == 0 || drive_source_selected_has(SOURCE_MEASURES)) c->salient_q20 = INT32_MAX;
  c->hold_gain_q30 = q_div(p->position_hold, c->nameplate.periods_per_second, 22);
  load_release(c);
  const current_design_t current = {p->current_bandwidth, DRIVE_PERIOD_US, p->current_divider,
                                    (current_corner_t)p->current_corner};
  mtpa_design(&c->mtpa, &c->nameplate);
  current_controller_design(&c->current, &c->nameplate, &current);
  speed_controller_t trial;
  return speed_controller_init(&trial, &c->speed, &c->nameplate);
}

// 1 / (time constant in slots of a kind), Q30, of a time in ms, Q8; 30 s means none.
static int32_t share_per_slot_q30(int32_t time_q8) {
  return (time_q8 >= 30000L * 256L) ? 0 : q_div(256L * (int32_t)SCHEDULE_SLOTS, time_q8 * DRIVE_PERIODS_PER_MS, 30);
}

// While the shaft is held the load is followed at once, five times as fast as at a crawl, and no step looked for. What
// a window shows is then worth nearly what the sensors are: a fifth of the usual noise, twice that of their own. The
// noise grows as 225 rad/s over the hold's own bandwidth, up to the usual.
static void load_hold_observer(drive_config_t* c, deviation_observer_tuning_t* t) {
  const int32_t share_q24 = q_div(RELEASE_STEP_END_Q30 / 5, c->release_step_q30, 24);
  t->noise_q20 = q_min(qc_mul_sat(t->noise_q20, share_q24, 24), t->noise_q20);
  t->load_rate_q20 *= 2;
  t->load_rate_quiet_q20 = t->load_rate_q20;
  t->load_step_q20 = 0;
  t->steps_at_speed = false;
  c->hold_observer = c->observer;
  deviation_observer_design(&c->hold_observer, &c->nameplate, t);
}

static bool load_position(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  c->avv.bandwidth_short_q30 = bandwidth_step_q30(p->avv_bandwidth_short);
  c->avv.bandwidth_long_q30 = bandwidth_step_q30(q_max(p->avv_bandwidth_long, p->avv_bandwidth_short));
  // Without the map the angle turns with the current, and a load that is followed fast closes a loop over that.
  c->mapped = (p->map_known | p->ldq_1 | p->ldq_2 | p->ldq_3 | p->ldq_4) != 0;
  deviation_observer_tuning_t observer = {qc_mul(p->observer_noise, 1073741824L, 18) / 1000,
                                          p->observer_load_rate,
                                          p->observer_load_quiet,
                                          c->mapped ? p->observer_load_step : p->observer_load_step / 4 * 3,
                                          config_slow_bpp(c, CRAWL_MAX_RPM),
                                          c->mapped};
  deviation_observer_design(&c->observer, &c->nameplate, &observer);
  c->observer.cogging.order = p->cogging_order;
  // Cogging is no larger than what a load is expected to change by.
  c->observer.cogging.bound_q8 =
      q_min(qc_mul_sat(c->nameplate.accel_q12, p->observer_load_rate, 24), COGGING_BOUND_END_Q8);
  c->observer.zero_vectors_only = p->observer_windows == 0;
  load_hold_observer(c, &observer);
  c->synchronism.floor_q16 = p->synchronism_floor;
  c->synchronism.share_q15 = qc_mul(p->synchronism_share, 85899346L, 26);  // percent Q8 to Q15
  c->synchronism.bad_periods = p->synchronism_time * DRIVE_PERIODS_PER_MS;
  c->adapt_share_q30 = share_per_slot_q30(p->adapt_time);
  c->drift_share_q30 = share_per_slot_q30(p->drift_time);
  // dLqq/di_d = dLdq/di_q, the slope of the map's first segment, over Lq. The other one comes in percent, Q24.
  c->saturation.q_q30 = q_div(q_div(p->ldq_1, p->inductance_q, 30), p->map_current / 4, 20);
  c->saturation.d_q30 = qc_mul(p->saturation_d, 687194767L, 30);
  c->slopes.amps_per_code_q30 = qc_mul(p->current_full_scale, 1073741824L, 31);  // full scale / 2048
  c->codes_per_amp_q16 = q_div(65536L, c->slopes.amps_per_code_q30, 30);
  c->sensor_mismatch_q30 = qc_mul(p->sensor_mismatch, 167772L, 10);  // percent, Q16
  c->slopes.start_samples = HAL_ADC_START_SAMPLES;
  c->slopes.end_samples = HAL_ADC_END_SAMPLES;
  slopes_design(&c->slopes);
  c->volts_per_code_q16 = q_shr_round(p->link_full_scale, 12);
  return blend_design(&c->blend, qc_mul_sat(p->blend_low, c->bpp_per_rpm_q8, 24),
                      qc_mul_sat(p->blend_high, c->bpp_per_rpm_q8, 24));
}

// Parameters as they are, by their places in the table.
static void load_values(config_values_t* v) {
#define CONFIG_VALUE(name) PARAMETER_PLACE(name),
  static const uint16_t places[] = {
#include "firmware/interfaces/all_config_values.h"
  };
#undef CONFIG_VALUE
  int32_t* const to = (int32_t*)(void*)v;
  for (uint16_t k = 0; k < sizeof places / sizeof places[0]; k++) to[k] = parameter_at(places[k]);
}

static packed_text_t make_parts(drive_config_t* c) {
  packed_text_t conflict = PACKED_NONE;
  for (uint16_t k = 0; edition_config_parts[k] != NULL && conflict == PACKED_NONE; k++) {
    if (edition_config_parts[k]->make != NULL) conflict = edition_config_parts[k]->make(c);
  }
  return conflict;
}

static drive_config_t made;  // too large for the stack; the background level alone makes configurations

packed_text_t drive_config_make(void) {
  clear(&made, sizeof made);
  load_values(&made.values);
  load_modulation(&made);
  const bool fits = load_machine(&made) && load_control(&made) && load_position(&made);
  return fits ? make_parts(&made) : SAY_the_machine_s_parameters_are_too_extreme;
}

void drive_config_take(drive_config_t* c) {
  *c = made;
  for (uint16_t k = 0; edition_config_parts[k] != NULL; k++) {
    if (edition_config_parts[k]->take != NULL) edition_config_parts[k]->take();
  }
}

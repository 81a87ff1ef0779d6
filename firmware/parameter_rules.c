// What the table's ranges cannot say: which parameters must fit together.

#include <stddef.h>

#include "firmware/drive.h"
#include "firmware/parameters.h"
#include "hal/hal_pwm.h"

#define SAMPLING_MIN_Q16 294912L    // 4.5 us: two bursts and the shortest useful time between them
#define EDGE_SHIFT_MAX_Q16 157286L  // 2.4 us: the room that the modulator keeps before the first edge

// Peak line-to-line EMF at the speed limit, V Q16: sqrt(3) lambda w.
static int32_t largest_emf_q16(const parameters_t* p) {
  const int32_t volts_q16 = q_mul_sat(p->magnet_flux, p->speed_limit * p->pole_pairs, 20);
  return q_mul(volts_q16, 194755224L, 30);  // sqrt(3) 2 pi / 60
}

// Lqq below Ldd at one of the map's points.
static bool map_is_crossed(const parameters_t* p) {
  const int32_t lqq[] = {p->lqq_1, p->lqq_2, p->lqq_3, p->lqq_4};
  const int32_t ldd[] = {p->ldd_1, p->ldd_2, p->ldd_3, p->ldd_4};
  for (uint16_t k = 0; k < 4u; k++) {
    if ((int64_t)lqq[k] * p->inductance_q < (int64_t)ldd[k] * p->inductance_d) return true;
  }
  return false;
}

const char* drive_config_or_conflict(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  if (p->inductance_q < p->inductance_d) return "inductance_q must be at least inductance_d";
  if (p->blend_high <= p->blend_low) return "blend_high must be above blend_low";
  if (p->flux_high <= p->flux_low) return "flux_high must be above flux_low";
  if (p->window_maximum < p->window_minimum) return "window_maximum must be at least window_minimum";
  if (p->link_maximum <= p->link_minimum) return "link_maximum must be above link_minimum";
  if (p->link_regulation <= p->link_minimum || p->link_regulation > p->link_maximum - 65536L)
    return "link_regulation must be above link_minimum, and 1 V or more below link_maximum";
  if (p->dead_time + p->turn_on_delay < p->turn_off_delay)
    return "turn_off_delay must not exceed dead_time + turn_on_delay";
  if (p->dead_time + p->turn_on_delay > EDGE_SHIFT_MAX_Q16) return "dead_time + turn_on_delay must not exceed 2.4 us";
  if (p->trip_current < p->current_limit) return "trip_current must be at least current_limit";
  if (p->trip_current > p->current_full_scale / 100 * 97)
    return "trip_current must be below 97 % of current_full_scale";
  if (p->link_maximum > p->link_full_scale / 100 * 97) return "link_maximum must be below 97 % of link_full_scale";
  // A fault switches the gates off at any speed; the diodes then charge the link up to the EMF.
  if (largest_emf_q16(p) > p->link_maximum)
    return "speed_limit is too high: with the gates off the EMF would charge the link beyond link_maximum";
  if (p->weakening_limit > p->current_limit) return "weakening_limit must not exceed current_limit";
  if (p->window_minimum < p->settle_time + SAMPLING_MIN_Q16)
    return "window_minimum must be settle_time + 4.5 us or more";
  if (p->pulse_time / 20 * 13 < p->settle_time + SAMPLING_MIN_Q16)
    return "0.65 pulse_time must be settle_time + 4.5 us or more";
  if (p->position_source == POSITION_PAPER && q_abs_sat(p->id_low_speed) < 1048576L)
    return "position_source 1 needs id_low_speed of 1 A or more";
  if ((p->excitation == 0 || p->excitation >= 4) &&
      (p->position_source == POSITION_OBSERVER_AVV || p->position_source == POSITION_AVV))
    return "excitation 0, 4 and 5 have no two active vectors for AVV";
  if (p->hold_time > 0 && p->excitation != 2 && p->excitation != 3 && p->excitation != 5)
    return "hold_time needs excitation 2, 3 or 5";
  if (map_is_crossed(p)) return "lqq_1 .. lqq_4 of inductance_q must not be less than ldd_1 .. ldd_4 of inductance_d";
  if (p->current_law == CURRENT_LAW_HYSTERESIS && p->position_source != POSITION_ENCODER)
    return "current_law 1 needs position_source 0";
  if (HAL_PWM_PERIOD_TICKS % (uint32_t)q_shr_round(p->slice_time * 100, 16) != 0u)
    return "100 us must be a whole number of slice_time";
  if (p->flux_beside > 0 && p->position_source != POSITION_ENCODER) return "flux_beside needs position_source 0";
  if (p->start_method == 1 && p->position_source == POSITION_ENCODER)
    return "start_method 1 needs a position_source other than 0: the encoder has no zero yet";
  if (p->start_method == 1 && p->if_current > p->current_limit)
    return "if_current must not exceed current_limit with start_method 1";
  if (p->current_bandwidth * (3 + p->current_divider) > 10400)
    return "current_bandwidth must not exceed 2080 rad/s with current_divider 2";
  return drive_config_load(c) ? NULL
                              : "the machine's parameters are too extreme together: inertia, flux, inductances, map";
}

const drive_config_t* drive_config_made(const char** conflict) {
  static drive_config_t made;
  made = drive.config;
  *conflict = drive_config_or_conflict(&made);
  return &made;
}

const char* parameter_conflict(void) {
  const char* conflict;
  (void)drive_config_made(&conflict);
  return conflict;
}

// Whatever changes a parameter asks for a new configuration, which finds out.
const char* parameter_conflict_known(void) {
  return (drive.conflict_known && !drive.request.reload) ? drive.conflict : parameter_conflict();
}

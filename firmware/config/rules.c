// What the table's ranges cannot say: which parameters must fit together.

#include "firmware/config/rules.h"

#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/text/packed_text.h"
#include "hal/qmath/qcall.h"

#define SAMPLING_MIN_Q16 294912L         // 4.5 us: two bursts and the shortest useful time between them
#define EDGE_SHIFT_MAX_Q16 157286L       // 2.4 us: the room that the modulator keeps before the first edge
#define ELECTRICAL_MAX_RPM_Q8 15360000L  // 1 kHz: ten control interrupts to a turn

// Peak line-to-line EMF at the speed limit, V Q16: sqrt(3) lambda w.
static int32_t largest_emf_q16(const parameters_t* p) {
  const int32_t volts_q16 = qc_mul_sat(p->magnet_flux, p->speed_limit * p->pole_pairs, 20);
  return qc_mul(volts_q16, 194755224L, 30);  // sqrt(3) 2 pi / 60
}

// Lqq below Ldd at one of the map's points.
static bool map_is_crossed(const parameters_t* p) {
  for (uint16_t k = 0; k < 4u; k++) {
    const int64_t lqq = q_product(parameter_at(PARAMETER_PLACE(lqq_1) + k), p->inductance_q);
    if (lqq < q_product(parameter_at(PARAMETER_PLACE(ldd_1) + k), p->inductance_d)) return true;
  }
  return false;
}

packed_text_t parameter_rule_broken(void) {
  const parameters_t* const p = &parameters;
  if (drive_source_is_left_out(p)) return SAY_position_source_is_not_in_this_edition;
  if (p->inductance_q < p->inductance_d) return SAY_inductance_q_must_be_at_least_inductance;
  if (p->blend_high <= p->blend_low) return SAY_blend_high_must_be_above_blend_low;
  if (p->window_maximum < p->window_minimum) return SAY_window_maximum_must_be_at_least_window;
  if (p->link_maximum <= p->link_minimum) return SAY_link_maximum_must_be_above_link_minimum;
  if (p->link_regulation <= p->link_minimum || p->link_regulation > p->link_maximum - 65536L)
    return SAY_link_regulation_must_be_above_link_minimum;
  if (p->dead_time + p->turn_on_delay < p->turn_off_delay) return SAY_turn_off_delay_must_not_exceed_dead;
  if (p->dead_time + p->turn_on_delay > EDGE_SHIFT_MAX_Q16) return SAY_dead_time_turn_on_delay_must_not;
  if (p->trip_current < p->current_limit) return SAY_trip_current_must_be_at_least_current;
  if (p->trip_current > p->current_full_scale / 100 * 97) return SAY_trip_current_must_be_below_97_of;
  if (p->link_maximum > p->link_full_scale / 100 * 97) return SAY_link_maximum_must_be_below_97_of;
  if (p->speed_limit * p->pole_pairs > ELECTRICAL_MAX_RPM_Q8) return SAY_speed_limit_pole_pairs_must_not_exceed;
  // A fault switches the gates off at any speed; the diodes then charge the link up to the EMF.
  if (largest_emf_q16(p) > p->link_maximum) return SAY_speed_limit_is_too_high_with_the;
  if (p->weakening_limit > p->current_limit) return SAY_weakening_limit_must_not_exceed_current_limi;
  if (p->window_minimum < p->settle_time + SAMPLING_MIN_Q16) return SAY_window_minimum_must_be_settle_time_4;
  if (p->pulse_time / 20 * 13 < p->settle_time + SAMPLING_MIN_Q16) return SAY_0_65_pulse_time_must_be_settle;
  if ((p->excitation == 0 || p->excitation >= 4) && drive_source_selected_has(SOURCE_ACTIVE))
    return SAY_avv_needs_two_active_vectors;
  if (p->hold_time > 0 && p->excitation != 2 && p->excitation != 3 && p->excitation != 5)
    return SAY_hold_time_needs_excitation_2_3_or;
  if (map_is_crossed(p)) return SAY_lqq_n_inductance_q_must_be;
  if (p->current_bandwidth * (3 + p->current_divider) > 10400) return SAY_current_bandwidth_must_not_exceed_2080_rad;
  return PACKED_NONE;
}

packed_text_t parameter_conflict(void) {
  const packed_text_t broken = parameter_rule_broken();
  return (broken != PACKED_NONE) ? broken : drive_config_make();
}

// No interrupt reads the table, so nobody sees the value meanwhile.
packed_text_t parameter_conflict_with(const parameter_info_t* p, int32_t raw) {
  int32_t* const value = parameter_in_use(p);
  const int32_t before = *value;
  *value = raw;
  const packed_text_t conflict = parameter_conflict();
  *value = before;
  return conflict;
}

// Whatever changes a parameter asks for a new configuration, which finds out.
packed_text_t parameter_conflict_known(void) {
  return (drive.conflict_known && !drive.request.reload) ? drive.conflict : parameter_conflict();
}

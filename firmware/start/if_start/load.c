// The I-F start's constants, of its parameters.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/start/if_start/if_start.h"
#include "hal/qmath/qcall.h"

if_start_config_t if_ramp_config;
bool if_is_blind;

static if_start_config_t made;

static packed_text_t make(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  made.current_q20 = p->if_current;
  made.align_periods = p->if_align * DRIVE_PERIODS_PER_MS;
  made.step_bpp = qc_mul_sat(p->if_acceleration, c->bpp_per_rpm_q8, 16) / 10000;
  made.speed_bpp = qc_mul_sat(p->if_speed, c->bpp_per_rpm_q8, 16);
  made.wait_periods = p->if_time * DRIVE_PERIODS_PER_MS;
  const bool fits = if_start_design(&made, &c->nameplate);
  if (p->start_method == 0) return PACKED_NONE;
  if (drive_source_selected_has(SOURCE_MEASURES)) return SAY_start_method_1_needs_a_position_source;
  if (p->if_current > p->current_limit) return SAY_if_current_must_not_exceed_current_limit;
  return fits ? PACKED_NONE : SAY_the_machine_s_parameters_are_too_extreme;
}

static void take(void) {
  if_ramp_config = made;
  start_ways.open_loop = parameters.start_method != 0;
  // Lq less than an eighth above Ld.
  if_is_blind = start_ways.open_loop && parameters.inductance_q - parameters.inductance_d < parameters.inductance_d / 8;
}

const config_part_t if_ramp_part = {make, take};

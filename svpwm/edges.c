#include "svpwm/edges.h"

void svpwm_compensate_edges(const dead_time_config_t* c, const sampling_config_t* sampling,
                            const svpwm_carried_t* carried, svpwm_pattern_t* pattern, uint16_t rise[],
                            uint16_t fall[]) {
  const svpwm_pulses_t* const p = &pattern->pulses;
  svpwm_ripple_legs_t legs;
  svpwm_ripple_walk_t walk = svpwm_ripple_walk(p, frame_phases(carried->current_q20), carried->inverse_inductance_q30,
                                               carried->link_q16, c->per_band_q24, &legs);
  const dead_time_delay_t delay = dead_time_delay(c);
  svpwm_finder_t finder = svpwm_finder(sampling, pattern);
  for (unsigned k = 0; k < SVPWM_EDGES; k++) {
    const unsigned edge = p->order[k];
    const int32_t tick = p->at[edge];
    int32_t earliest = tick, latest = tick, blocking_q12;
    unsigned leg = edge;
    uint16_t* told = rise;
    if (edge < SVPWM_LEGS) {
      blocking_q12 = svpwm_ripple_rise(&walk, &legs, leg, tick);
    } else {
      leg = edge - SVPWM_LEGS;
      told = fall;
      blocking_q12 = svpwm_ripple_fall(&walk, &legs, leg, tick);
    }
    const int32_t sent = tick - dead_time_delay_ticks(&delay, blocking_q12);
    told[leg] = (uint16_t)sent;
    if (dead_time_is_in_doubt(c, blocking_q12)) {
      earliest = sent + c->turn_off_ticks;
      latest = sent + c->turn_on_ticks;
      svpwm_finder_beware(&finder, sampling, pattern, earliest);
    }
    svpwm_finder_pass(&finder, sampling, pattern, leg, earliest, latest);
  }
  svpwm_finder_finish(&finder, sampling, pattern);
}

#include "svpwm/edges.h"

void svpwm_compensate_edges(const dead_time_config_t* c, const sampling_config_t* sampling,
                            const svpwm_carried_t* carried, svpwm_pattern_t* pattern, uint16_t sent[]) {
  const svpwm_pulses_t* const p = &pattern->pulses;
  svpwm_ripple_legs_t legs;
  svpwm_ripple_walk_t walk = svpwm_ripple_walk(p, carried->shares_q12, carried->inverse_inductance_q30,
                                               carried->link_q16, c->per_band_q24, &legs);
  svpwm_finder_t finder = svpwm_finder(sampling, pattern);
  for (unsigned k = 0; k < SVPWM_EDGES; k++) {
    const unsigned edge = p->order[k];
    const int32_t tick = p->at[edge];
    const int32_t blocking_q12 = svpwm_ripple_blocking(&walk, &legs, edge, tick);
    const int32_t at = tick - dead_time_delay_ticks(c, blocking_q12);
    int32_t earliest = tick, latest = tick;
    sent[edge] = (uint16_t)at;
    if (dead_time_is_in_doubt(c, blocking_q12)) {
      earliest = at + c->turn_off_ticks;
      latest = at + c->turn_on_ticks;
      svpwm_finder_beware(&finder, sampling, pattern, earliest);
    }
    svpwm_finder_pass(&finder, sampling, pattern, edge, earliest, latest);
  }
  svpwm_finder_finish(&finder, sampling, pattern);
}

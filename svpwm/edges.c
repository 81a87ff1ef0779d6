#include "svpwm/edges.h"

void svpwm_compensate_edges(const dead_time_config_t* c, const sampling_config_t* sampling,
                            const svpwm_carried_t* carried, svpwm_pattern_t* pattern, svpwm_pulses_t* command) {
  svpwm_ripple_walk_t walk = svpwm_ripple_walk(&pattern->pulses, frame_inverse_clarke(carried->current_q20),
                                               carried->inverse_inductance_q30, carried->link_q16);
  svpwm_finder_t finder = svpwm_finder(sampling, pattern);
  while (walk.order != 0u) {
    const svpwm_ripple_edge_t e = svpwm_ripple_next(&walk);
    svpwm_arrival_t arrival;
    command->at[e.edge] = (int16_t)dead_time_compensate(c, &e, &arrival);
    svpwm_finder_pass(&finder, e.leg, &arrival);
  }
  svpwm_finder_finish(&finder);
}

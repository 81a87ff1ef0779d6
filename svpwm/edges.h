// From the edges that are wanted at the motor to those that are sent, and to the windows between them: one pass.

#ifndef STILLSPIN_SVPWM_EDGES_H
#define STILLSPIN_SVPWM_EDGES_H

#include "svpwm/dead_time.h"
#include "svpwm/ripple.h"
#include "svpwm/windows.h"

/// What the legs carry in the period, for the current at an edge.
typedef struct {
  abc_t shares_q12;                // mean currents as shares of the dead time's band
  int32_t inverse_inductance_q30;  // mean T/L, A per V and period
  int32_t link_q16;                // DC link, V
} svpwm_carried_t;

/// When each edge has to be sent, ticks, for the motor to see the edges of the pattern's pulses; and the pattern's
/// windows.
void svpwm_compensate_edges(const dead_time_config_t* c, const sampling_config_t* sampling,
                            const svpwm_carried_t* carried, svpwm_pattern_t* pattern, uint16_t sent[]);

#endif

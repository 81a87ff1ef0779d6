// Dead-time and device-drop compensation.
//
// During the dead time the current decides: with the current out of the leg (i > 0) the lower diode holds the leg low
// until the upper device turns on, with i < 0 the upper diode lifts it as soon as the lower device lets go. So an edge
// follows its command by dead time + turn-on delay or by the turn-off delay, and the command is advanced by that much.
// What counts is the current *at the edge*, ripple included. Between the two signs the shift is interpolated: there the
// current clamps at zero for part of the dead time. Physics, section 5.

#ifndef STILLSPIN_SVPWM_DEAD_TIME_H
#define STILLSPIN_SVPWM_DEAD_TIME_H

#include "svpwm/windows.h"

typedef struct {
  int16_t blocked_ticks;   // dead time + turn-on delay, 0..240
  int16_t released_ticks;  // turn-off delay, 0..blocked
  int32_t edge_band_q20;   // error that a predicted current at an edge may have, A
  int32_t band_q20;        // current below which the sign is not trusted, A, 0.01..2
  int32_t drop_q16;        // on-state drop of a device, V, 0..5 (its resistance belongs to Rs)
  // Set by dead_time_design.
  int32_t per_band_q29, third_drop_q24, side_drop_q24;  // of band and drop
  int16_t blocked_delay_ticks, released_delay_ticks;    // of an edge where the sign is trusted
} dead_time_config_t;

/// Edges whose sign of the current is not certain: bit `leg` a rising one, bit 3 + `leg` a falling one.
typedef uint16_t dead_time_edges_t;

/// Derives the constants; the first five members are set by hand.
void dead_time_design(dead_time_config_t* c);

/// Commands that make the motor see the pattern's edges. current_q20: mean phase currents in that period, alpha-beta,
/// A; admittance_q30: mean T/L, A per V and period; link_q16: DC link, V. Returns the edges where the current is below
/// edge_band: with the other sign than predicted they come up to blocked - released ticks early or late.
dead_time_edges_t dead_time_compensate(const dead_time_config_t* c, const svpwm_pulses_t* wanted, ab_t current_q20,
                                       int32_t admittance_q30, int32_t link_q16, svpwm_pulses_t* command);

/// Keeps the samples of a pattern off the uncertain edges: a window begins where its edge has come at the latest, and
/// ends where it can come at the earliest; one that is then too short goes.
void dead_time_guard_windows(const dead_time_config_t* c, const sampling_config_t* sampling,
                             const svpwm_pulses_t* command, dead_time_edges_t uncertain, svpwm_pattern_t* pattern);

/// Voltage lost in the devices at these currents, V Q16: subtract it from a leg model, or add it to a command.
ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20);

#endif

// Dead-time and device-drop compensation.
//
// During the dead time the current decides: with the current out of the leg (i > 0) the lower diode holds the leg low
// until the upper device turns on, with i < 0 the upper diode lifts it as soon as the lower device lets go. So an edge
// follows its command by dead time + turn-on delay or by the turn-off delay, and the command is advanced by that much.
// What counts is the current *at the edge*, ripple included. Between the two signs the shift is interpolated: there the
// current clamps at zero for part of the dead time. Physics, section 5.

#ifndef STILLSPIN_SVPWM_DEAD_TIME_H
#define STILLSPIN_SVPWM_DEAD_TIME_H

#include "svpwm/ripple.h"

typedef struct {
  int16_t turn_on_ticks;   // dead time + turn-on delay, 0..240
  int16_t turn_off_ticks;  // turn-off delay, 0..turn_on_ticks
  int32_t edge_band_q20;   // error that a predicted current at an edge may have, A
  int32_t band_q20;        // current below which the sign is not trusted, A, 0.01..2
  int32_t drop_q16;        // on-state drop of a device, V, 0..5 (its resistance belongs to Rs)
  // Set by dead_time_design.
  int32_t per_band_q29, third_drop_q27, side_drop_q27;  // of band and drop
  int32_t certain_q20;                                  // current from which on its sign is trusted and certain
} dead_time_config_t;

/// Derives the constants; the first five members are set by hand.
void dead_time_design(dead_time_config_t* c);

/// Delay of an edge, ticks; the current is positive where it blocks the edge.
static inline int32_t dead_time_delay_ticks(const dead_time_config_t* c, int32_t blocking_q20) {
  if (blocking_q20 >= c->band_q20) return c->turn_on_ticks;
  if (blocking_q20 <= -c->band_q20) return c->turn_off_ticks;
  const int32_t middle = c->turn_on_ticks + c->turn_off_ticks;
  const int32_t half_range = c->turn_on_ticks - c->turn_off_ticks;
  return q_shr(middle * (int32_t)32768 + half_range * q_mul_hi(blocking_q20 * 8, c->per_band_q29) + 32768L, 16);
}

/// An edge at a current whose sign is not certain, or not trusted.
static inline int32_t dead_time_compensate_uncertain(const dead_time_config_t* c, const svpwm_ripple_edge_t* e,
                                                     svpwm_arrival_t* arrival) {
  const int32_t sent = e->tick - dead_time_delay_ticks(c, e->blocking_q20);
  if (e->blocking_q20 < c->edge_band_q20 && e->blocking_q20 > -c->edge_band_q20) {
    arrival->earliest = sent + c->turn_off_ticks;
    arrival->latest = sent + c->turn_on_ticks;
  }
  return sent;
}

/// The command, in ticks, that makes the motor see an edge where it is wanted. With a current below edge_band an edge
/// is not certain: with the other sign than predicted it comes up to the turn-on less the turn-off delay early or late.
static inline int32_t dead_time_compensate(const dead_time_config_t* c, const svpwm_ripple_edge_t* e,
                                           svpwm_arrival_t* arrival) {
  arrival->earliest = e->tick;
  arrival->latest = e->tick;
  if (e->blocking_q20 >= c->certain_q20) return e->tick - c->turn_on_ticks;
  if (e->blocking_q20 <= -c->certain_q20) return e->tick - c->turn_off_ticks;
  return dead_time_compensate_uncertain(c, e, arrival);
}

/// Sign of a current as -1..1, Q21, linear inside the band.
static inline int32_t dead_time_sign_q21(const dead_time_config_t* c, int32_t current_q20) {
  if (current_q20 >= c->band_q20) return 2097152L;
  if (current_q20 <= -c->band_q20) return -2097152L;
  return q_mul_hi(current_q20 * 512, c->per_band_q29);
}

/// Voltage lost in the devices at these currents, V Q16: subtract it from a leg model, or add it to a command.
static inline ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20) {
  const abc_t i = frame_inverse_clarke(current_q20);
  const int32_t x = dead_time_sign_q21(c, i.a);
  const int32_t y = dead_time_sign_q21(c, i.b);
  const int32_t z = dead_time_sign_q21(c, i.c);
  // Q21 times Q27: the upper word is Q16.
  const ab_t drop = {q_mul_hi(2 * x - y - z, c->third_drop_q27), q_mul_hi(y - z, c->side_drop_q27)};
  return drop;
}

#endif

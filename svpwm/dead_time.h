// Dead-time and device-drop compensation.
//
// During the dead time the current decides: with the current out of the leg (i > 0) the lower diode holds the leg low
// until the upper device turns on, with i < 0 the upper diode lifts it as soon as the lower device lets go. So an edge
// follows its command by dead time + turn-on delay or by the turn-off delay, and the command is advanced by that much.
// What counts is the current *at the edge*, ripple included. Between the two signs the shift is interpolated: there the
// current clamps at zero for part of the dead time. Physics, section 5.

#ifndef STILLSPIN_SVPWM_DEAD_TIME_H
#define STILLSPIN_SVPWM_DEAD_TIME_H

#include "svpwm/pattern.h"

typedef struct {
  int16_t turn_on_ticks;   // dead time + turn-on delay, 0..240
  int16_t turn_off_ticks;  // turn-off delay, 0..turn_on_ticks
  int32_t edge_band_q20;   // error that a predicted current at an edge may have, A, at least the band
  int32_t band_q20;        // current below which the sign is not trusted, A, 0.01..2
  int32_t drop_q16;        // on-state drop of a device, V, 0..5 (its resistance belongs to Rs)
  // Set by dead_time_design. Currents at the edges are shares of the band.
  int32_t per_band_q24;         // 1 / band, 1/A
  int32_t middle_q13;           // delay without a current, ticks, and a half for rounding
  int16_t range_ticks;          // of the delay, from one sign to the other
  uint32_t doubt_q12;           // edge_band / band, just below
  int32_t third_q16, side_q16;  // drop / 3, drop / sqrt(3), V
} dead_time_config_t;

/// Derives the constants; the first five members are set by hand.
void dead_time_design(dead_time_config_t* c);

#define DEAD_TIME_BAND_BITS 12u

/// What the phases carry as shares of the band.
static inline abc_t dead_time_shares_q12(const dead_time_config_t* c, ab_t current_q20) {
  const abc_t i = frame_inverse_clarke(current_q20);
  const abc_t shares = {q_mul_hi(i.a, c->per_band_q24), q_mul_hi(i.b, c->per_band_q24), q_mul_hi(i.c, c->per_band_q24)};
  return shares;
}

/// Delay of an edge, ticks. The current is a share of the band, positive where it blocks the edge.
static inline int32_t dead_time_delay_ticks(const dead_time_config_t* c, int32_t blocking_q12) {
  const int32_t in_band_q12 = q_within_bits(blocking_q12, DEAD_TIME_BAND_BITS);
  return q_shr(c->middle_q13 + (int16_t)in_band_q12 * (int32_t)c->range_ticks, 13);
}

/// With a current below edge_band an edge is not certain: with the other sign than predicted it comes up to turn-on
/// less turn-off delay early or late.
static inline bool dead_time_is_in_doubt(const dead_time_config_t* c, int32_t blocking_q12) {
  return (uint32_t)blocking_q12 + c->doubt_q12 <= 2u * c->doubt_q12;
}

/// Voltage lost in the devices at these shares, V Q16: subtract it from a leg model, or add it to a command.
static inline ab_t dead_time_drop_of_q16(const dead_time_config_t* c, abc_t shares_q12) {
  const int32_t x = q_within_bits(shares_q12.a, DEAD_TIME_BAND_BITS);
  const int32_t y = q_within_bits(shares_q12.b, DEAD_TIME_BAND_BITS);
  const int32_t z = q_within_bits(shares_q12.c, DEAD_TIME_BAND_BITS);
  const ab_t drop = {q_shr((2 * x - y - z) * c->third_q16, DEAD_TIME_BAND_BITS),
                     q_shr((y - z) * c->side_q16, DEAD_TIME_BAND_BITS)};
  return drop;
}

/// The same at these currents.
static inline ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20) {
  return dead_time_drop_of_q16(c, dead_time_shares_q12(c, current_q20));
}

#endif

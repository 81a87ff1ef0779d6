// Standstill position control: at a speed reference of zero the shaft is kept where it came to rest.
//
// A speed loop alone lets the shaft creep: an error of the estimated speed, or a torque that falls as the shaft moves
// on (the far side of a hump of the cogging), turns it further and further. Here the angle turned since rest,
// e = theta_0 - theta, asks for a speed that brings it back,
//   w* = k e,   |e| <= half an electrical turn,
// a loop around the speed loop with the time constant 1/k. Beyond half a turn the position to hold is dragged along: a
// load that the current limit cannot hold finds no torque wound up against it.

#ifndef STILLSPIN_CONTROL_POSITION_HOLD_H
#define STILLSPIN_CONTROL_POSITION_HOLD_H

#include <stdbool.h>

#include "hal/qmath/qmath.h"

typedef struct {
  bool holding;
  uint32_t angle_bam;   // electrical, at the last step
  int32_t to_turn_q28;  // e, electrical turns, -0.5..0.5
} position_hold_t;

/// Lets the shaft go.
static inline void position_hold_release(position_hold_t* h) { h->holding = false; }

/// One step; the first after a release takes the angle for the position to hold. The angle turns less than half a turn
/// between steps. The gain is k over the PWM periods per second, Q30, 0..0.01; returns w*, binary angle per period.
int32_t position_hold_step(position_hold_t* h, uint32_t angle_bam, int32_t gain_q30);

#endif

// Whether motor, gates and current sensors are wired as configured: from what the axis was found with (axis.h).
//
// On a shaft that stands the currents under the six active vectors rise by di = Y dv. Summed over a round, the windows
// give the four entries of the matrix between the voltages that were switched and the currents that two sensors read,
//
//   Y = | y + x   c - u |      y mean inverse inductance, (x, c) saliency, u curl
//       | c + u   y - x |
//
// A motor, whatever its saliency and wherever its rotor stands, has u = 0 and y above the length of (x, c). Every
// mistake breaks this: an open phase leaves current on a line alone, y = |(x, c)|; a sensor that shows nothing does so
// with a curl; a reversed sensor, or two that are exchanged, make the determinant negative; others make y negative or
// the curl large. A back-EMF is under all vectors the same and cancels.
//
// Which mistake it is say the voltages under which each sensor sees most: those of its own phase at 0 and 120 degrees,
// give or take asin(saliency). Motor wires that are exchanged are not seen: the motor is another one that turns the
// other way.

#ifndef STILLSPIN_ESTIMATORS_WIRING_H
#define STILLSPIN_ESTIMATORS_WIRING_H

#include "estimators/axis.h"

typedef enum {
  WIRING_GOOD = 0,  // or too little to tell
  WIRING_NO_CURRENT = 1,
  WIRING_OPEN_A = 2,
  WIRING_OPEN_B = 3,
  WIRING_OPEN_C = 4,
  WIRING_DEAD_A = 5,
  WIRING_DEAD_B = 6,
  WIRING_REVERSED_A = 7,
  WIRING_REVERSED_B = 8,
  WIRING_REVERSED_BOTH = 9,
  WIRING_SWAPPED = 10,
  WIRING_OTHER_PHASES = 11
} wiring_t;

/// s: complete. m: the model that the regressions were made with. code_q20: a code of the converter, A.
wiring_t wiring_judge(const axis_t* s, const machine_model_t* m, int32_t code_q20);

#endif

// Flying start: angle, direction and speed of a rotor that turns, from two short circuits.
//
// Without voltage sensors nothing is seen while the gates are off. With all three lower devices on, the current
// grows as the back-EMF drives it: e = v - R i - L di/dt. In a short circuit that has lasted for much less than L/R and
// a quarter turn, the current lies along e and therefore along the q-axis, so L is Lq and no angle is needed. One pulse
// gives the direction and the size of the EMF; |e| = |w| lambda. Which way the rotor turns, the saliency and the size
// do not say: a second pulse does, after a pause in which the rotor should turn by some 60 degrees. The sense of that
// turn is the direction, its size over the time the speed, and e = w lambda q fixes the polarity as well.
//
// Ends of a pulse are the first burst of its first window and the last one of its last; the direction of the chord is
// that of the EMF midway, but for the current on the q-axis that the turning saliency moves to the d-axis: w (Lq/Ld -
// 1) i_q, which turns it against the rotation by (Lq/Ld - 1) i_q / (y_q lambda/T). Times are ticks from any origin.
// Speeds up to 150 degrees between the pulses; a first size that is wrong by a factor of 2.5 is tolerated.

#ifndef STILLSPIN_ESTIMATORS_FLYING_H
#define STILLSPIN_ESTIMATORS_FLYING_H

#include "estimators/estimator.h"

/// A short circuit in the making.
typedef struct {
  int32_t first_tick, last_tick;
  ab_t first_q20, last_q20;  // currents there, A
  ab_t drive_q16;            // sum of v - R i over the windows, V
  uint16_t windows;
} flying_pulse_t;

/// The EMF in the middle of a pulse.
typedef struct {
  uint32_t direction_bam;
  int32_t size_q16;  // V, peak
  int32_t tick;
  int32_t lag_bam;  // by which the saliency turns the chord against the rotation
} flying_emf_t;

typedef struct {
  uint32_t angle_bam;  // of the rotor, magnet's north included, at the second pulse
  int32_t tick;        // when that was
  int32_t speed_bpp;
  int32_t sigma_q8;  // the turn seen over its error: how sure direction and polarity are
} flying_rotor_t;

static inline void flying_begin(flying_pulse_t* s) { s->windows = 0; }

/// Takes a window in which the short circuit lasted; tick: the window's middle.
void flying_add(flying_pulse_t* s, const machine_model_t* m, const estimator_window_t* w, int32_t tick);

/// Largest component of the current at the end of the pulse, A Q20.
int32_t flying_current(const flying_pulse_t* s);

/// Needs a window or more.
flying_emf_t flying_evaluate(const flying_pulse_t* s, const machine_model_t* m);

/// Magnitude of the speed that makes an EMF of this size (V), binary angle per period.
int32_t flying_speed(int32_t size_q16, const machine_model_t* m);

/// Periods in which a rotor with this EMF turns by 60 degrees, between least and most.
int32_t flying_pause(const flying_emf_t* e, const machine_model_t* m, int32_t least, int32_t most);

/// False when the turn between the pulses does not fit the size of the EMF.
bool flying_resolve(const flying_emf_t* first, const flying_emf_t* second, const machine_model_t* m,
                    flying_rotor_t* rotor);

#endif

// Inertia from a run-up: how far the shaft has turned against how far the torque should have turned it.
//
// When the speed reference moves after a rest, the drive knows beforehand why the torque changes. From there on the
// torque that is new is integrated twice, and so is what the shaft does, as an angle: the angle is known to a few
// degrees whatever the observer makes of the speed. With the load as before the ratio of the two is what the
// acceleration per torque is over what the model says, inertia and torque constant together:
//   ratio = (theta - theta0 - w0 t) / (double integral of the new torque's acceleration)
// It is judged after a quarter turn (3 degrees are 3 %), then after a whole one, four, sixteen. Little torque says
// nothing, and neither does a ratio within 1/16 of one. A load that came at the same time looks like inertia; it shows
// when the speed is steady again: if the torque then differs from that before by more than a quarter of the run-up's,
// what was found is taken back.
//
// Units: speeds in binary angle per period, accelerations Q8 of that per period, angles 2^-24 turn.

#ifndef STILLSPIN_ESTIMATORS_INERTIA_MATCH_H
#define STILLSPIN_ESTIMATORS_INERTIA_MATCH_H

#include <stdbool.h>

#include "hal/qmath/qmath.h"

typedef struct {
  uint32_t angle_bam;
  int32_t speed_bpp;        // observed
  int32_t reference_bpp;    // commanded
  int32_t torque_accel_q8;  // acceleration of the present torque, as the model in use has it
  int32_t least_accel_q8;   // a run-up with a smaller mean says nothing
  int32_t still_bpp;        // the reference is reached within this
} inertia_seen_t;

#define INERTIA_SAME_Q24 16777216L  // 1

typedef enum { INERTIA_REST = 0, INERTIA_RUN_UP = 1, INERTIA_SETTLE = 2 } inertia_phase_t;

typedef struct {
  int32_t ratio_q24;  // acceleration per torque over that of the parameters
  inertia_phase_t phase;
  uint16_t ms;              // in the phase
  uint16_t quiet_ms;        // with the reference at rest and reached
  int32_t reference_bpp;    // of the last millisecond
  int32_t base_q8;          // torque at rest, slow mean
  int32_t start_base_q8;    // the same at the run-up's beginning
  int32_t before_q24;       // the ratio then
  int32_t mean_q8;          // mean of the new torque
  int32_t speed0_bpp;       // speed then
  uint32_t angle_bam;       // of the last millisecond
  int32_t gained_bpp;       // speed that the new torque should have made
  int32_t last_gained_bpp;  // of the last millisecond
  int32_t expected, turned;
  int32_t next;  // angle at which is judged again
} inertia_match_t;

void inertia_match_reset(inertia_match_t* s);

/// Every period: the acceleration of its torque.
static inline void inertia_match_add(inertia_match_t* s, int32_t torque_accel_q8) {
  if (s->phase == INERTIA_RUN_UP) {
    s->gained_bpp = q_add_sat(s->gained_bpp, q_shr(q_sub_sat(torque_accel_q8, s->start_base_q8), 8));
  }
}

/// Every millisecond, `periods` after the last: returns by what factor (Q24) the acceleration per torque is to be
/// changed, 1 for not at all. `ratio_q24` has it already.
int32_t inertia_match_step(inertia_match_t* s, const inertia_seen_t* in, int32_t periods);

#endif

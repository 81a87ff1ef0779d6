// What the current loop is to do in a period.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_REFERENCES_H
#define STILLSPIN_FIRMWARE_INTERFACES_REFERENCES_H

#include <stdbool.h>
#include <stdint.h>

#include "control/frame.h"

/// Kept from period to period. They are the state's that is in hand: in START and COMMISSION its own, in RUN and STOP
/// the speed control's, and in a spin as well, but for what a spin wants of it. With the power stage the loop opens
/// (drive_open_power_stage). All others only read them, which the check `writers` sees to.
typedef struct {
  dq_t current_q20;          // A
  int32_t spin_d_q20;        // COMMISSION: i_d that its spin wants beside what weakens the field, A
  int32_t feed_forward_q16;  // q-axis voltage for a change of the current that is known beforehand, V
  bool closed;               // the loop is: else no voltage is commanded
} references_t;

#endif

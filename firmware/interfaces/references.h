// What the current loop is to do in a period.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_REFERENCES_H
#define STILLSPIN_FIRMWARE_INTERFACES_REFERENCES_H

#include <stdbool.h>
#include <stdint.h>

#include "control/frame.h"

/// Kept from period to period. They are the state's that is in hand: in START and COMMISSION its own, in RUN and STOP
/// and in a spin the speed control's. With the power stage the loop opens
/// (drive_open_power_stage). All others only read them, which the check `writers` sees to.
typedef struct {
  dq_t current_q20;          // A
  int32_t spin_d_q20;        // i_d of a spin, to which what weakens the field is added, A
  int32_t feed_forward_q16;  // q-axis voltage for a change of the current that is known beforehand, V
  bool closed;               // the loop is: else no voltage is commanded
} references_t;

#endif

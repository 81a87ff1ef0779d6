// The start: from READY to RUN.
//
// First the drive listens whether the shaft turns (two short circuits, flying.c). If it does, angle, polarity and
// speed come from the back-EMF and the drive runs on at that speed. If it stands, the axis comes from the saliency, the
// polarity from saturation where the machine's slopes are known and large enough, else from a small motion. What stays
// ambiguous is tried again with more current and then is a fault. A test whose current did not follow, because the DC
// link is too low for it, does not count: less current is tried, from the axis on.
//
// The same windows tell whether phases and current sensors are wired as they should be (estimators/wiring.h).
//
// With start_method 1 a shaft that stands is turned by a current vector instead (start/if_start.c): that needs no
// saliency.

#ifndef STILLSPIN_FIRMWARE_START_START_H
#define STILLSPIN_FIRMWARE_START_START_H

#include "control/if_start.h"
#include "estimators/axis.h"
#include "estimators/emf_sign.h"
#include "estimators/flying.h"
#include "estimators/followed.h"
#include "estimators/polarity.h"
#include "estimators/saturation.h"
#include "firmware/interfaces/state.h"

typedef enum {
  START_LISTEN = 0,      // gates off, the short circuit is prepared
  START_PULSE = 1,       // gates on, short circuit; off again, what it showed
  START_CATCH = 2,       // the rotor turns: current loop closed, estimators following
  START_AXIS = 3,        // zero mean voltage, the axis is found
  START_SETTLE = 4,      // current loop closed at zero
  START_SATURATION = 5,  // polarity by saturation
  START_MOTION = 6,      // polarity by motion
  START_IF_RAMP = 7,     // I-F start: a current vector turns the rotor
  START_CHARGE = 8       // all lower devices on: bootstrap capacitors
} start_phase_t;

typedef struct {
  uint16_t tick;   // periods since the phase was entered
  uint16_t pause;  // periods to listen before the next pulse
  uint16_t tries;  // of the present phase
  uint16_t pulses;
  uint16_t charged;      // periods in which the bootstrap capacitors were charged
  bool learnt;           // axis and inverse inductances of a caught rotor are
  int32_t on_tick;       // of the period in which the gates came on
  flying_rotor_t rotor;  // caught: at the second pulse, then carried on
  int32_t emf_q16;       // of that pulse, V
  int32_t stray;         // filtered angle error while catching, binary angle
  flying_pulse_t pulse;
  flying_emf_t first;
  axis_t axis;
  saturation_t saturation;
  polarity_t motion;
  followed_t followed;  // the current, what the present test asked of it
  uint16_t held_back;   // how often all began anew
  bool starved;         // the current of a test did not follow: less is tried
  if_start_t if_start;
} drive_start_t;

/// Its memory: a drive has one start.
extern drive_start_t starting;

/// As after power-on.
void start_reset(void);

extern const state_t start_state;

#endif

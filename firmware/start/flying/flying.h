// The start of a shaft that turns: the phases of START that find it and catch it, and what they remember.

#ifndef STILLSPIN_FIRMWARE_START_FLYING_FLYING_H
#define STILLSPIN_FIRMWARE_START_FLYING_FLYING_H

#include "estimators/flying.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/start/phases.h"

/// One at a time: a look begins it anew.
typedef struct {
  uint16_t pause;  // periods to listen before the next pulse
  uint16_t pulses;
  bool learnt;           // axis and inverse inductances of a caught rotor are,
  bool flux_due;         // and its flux is not yet
  flying_rotor_t rotor;  // caught: at the second pulse, then carried on
  int32_t emf_q16;       // of that pulse, V
  int32_t stray;         // filtered angle error while catching, binary angle
  flying_pulse_t pulse;
  flying_emf_t first;
} flying_start_t;

extern flying_start_t flying_start;

extern const config_part_t flying_part;

extern const phase_t listen_phase, pulse_phase, catch_phase;

#endif

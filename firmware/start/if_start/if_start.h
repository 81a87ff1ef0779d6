// The I-F start: a phase of START that turns the rotor by a current vector, what it remembers, and its constants.

#ifndef STILLSPIN_FIRMWARE_START_IF_START_IF_START_H
#define STILLSPIN_FIRMWARE_START_IF_START_IF_START_H

#include "control/if_start.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/start/phases.h"

extern if_start_t if_ramp;

/// Its constants in use.
extern if_start_config_t if_ramp_config;

/// The rotor has next to no saliency: below if_speed the vector keeps it, or takes it back.
extern bool if_is_blind;

extern const phase_t if_ramp_phase;
extern const state_t if_run_state;
extern const config_part_t if_ramp_part;

#endif

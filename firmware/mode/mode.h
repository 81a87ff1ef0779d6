// The drive: everything that lives from one control interrupt to the next.
//
// One instance, cleared at start-up. The control interrupt writes it, and the window interrupt sampling.h's buffers.
// The background level leaves requests in `request`, writes what it alone writes (said there), and changes the rest
// only with the interrupts held off: when a configuration is exchanged (drive/reload.c), or at a fault that it sees.

#ifndef STILLSPIN_FIRMWARE_MODE_MODE_H
#define STILLSPIN_FIRMWARE_MODE_MODE_H

#include "firmware/interfaces/config.h"
#include "firmware/interfaces/period.h"
#include "firmware/interfaces/state.h"
#include "firmware/mode/commands.h"
#include "firmware/text/packed_text.h"

typedef struct {
  bool stop, coast, reset, reload;
  const state_request_t* begin;  // a start, or what a feature has in its place: what came last; NULL: none
  // A speed and its value, which is written first: neither may change places.
  volatile bool speed;
  volatile int32_t speed_rpm_q16;
} drive_request_t;

/// What is read everywhere comes first, what is large last: the farther a member, the longer the code that reaches it.
typedef struct drive {
  drive_state_t state;
  drive_fault_t fault;
  uint32_t periods;  // since the state was entered
  state_flags_t flags;
  schedule_t schedule;
  uint32_t time_ms;    // control interrupts since power-on, in ms; wraps after 49 days
  uint16_t heartbeat;  // counts control interrupts, for the watchdog
  bool config_valid;
  bool conflict_known;  // of the parameters that the configuration was made of
  drive_request_t request;
  const position_source_t* source;  // by the parameter, selected when that changes
  packed_text_t conflict;           // why they do not fit together, or PACKED_NONE
  drive_estimate_t estimate;
  drive_control_t control;
  drive_samples_t samples;
  drive_modulation_t modulation;
  drive_supervision_t supervision;
  uint32_t settled_at;                           // period in which the currents will have been at rest for long enough
  int32_t zero_current_a_q8, zero_current_b_q8;  // currents at rest while the offsets are found, codes
  int32_t offset_residual_q8;  // mean deviation of the currents from their offsets while these are found, codes
  drive_config_t config;
} drive_t;

extern drive_t drive;

/// What is made of the parameters is to be made anew.
void drive_parameters_changed(void);
/// The one that the parameter selects; the edition's default one where it leaves that out, and the drive does not
/// start.
const position_source_t* drive_source_selected(void);
/// Whether that has this trait.
bool drive_source_selected_has(uint16_t trait);
/// Whether this edition leaves out the one that these values name.
bool drive_source_is_left_out(const parameters_t* p);

/// Whether the source in use has this trait.
static inline bool drive_source_has(const drive_t* d, uint16_t trait) { return (d->source->traits & trait) != 0u; }

/// True where the speed control and the chosen position source are at work.
static inline bool drive_is_turning(const drive_t* d) {
  return d->state == DRIVE_RUN || d->state == DRIVE_STOP || d->flags.spins;
}

/// Bits of known_t that are not the drive's own: the board, which has the only one, writes it at background level.
extern uint16_t known_beside;
/// The bits of known_t.
uint16_t drive_known(const volatile drive_t* d);

/// Mechanical speed, rpm Q16, of an electrical one.
int32_t drive_rpm_q16(const drive_t* d, int32_t speed_bpp);

/// Latches a fault with its circumstances (fault_history.h) and opens the power stage. The speed command is forgotten.
void drive_trip(drive_t* d, drive_fault_t fault);

/// Opens the power stage, and the current loop with it.
void drive_open_power_stage(drive_t* d);

/// COMMISSION, at rest until now: speed control and position source have the shaft, as at the beginning of a run.
void drive_begin_spin(drive_t* d);

/// Enters a state and starts counting its periods.
void drive_enter(drive_t* d, drive_state_t state);

#endif

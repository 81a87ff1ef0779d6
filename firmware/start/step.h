// What the phases of the start have in common: its memory, and what each may do.

#ifndef STILLSPIN_FIRMWARE_START_STEP_H
#define STILLSPIN_FIRMWARE_START_STEP_H

#include "estimators/axis.h"
#include "estimators/followed.h"
#include "estimators/polarity.h"
#include "estimators/saturation.h"
#include "firmware/mode/mode.h"

typedef enum {
  START_LISTEN = 0,      // gates off, the short circuit is prepared
  START_PULSE = 1,       // gates on, short circuit; off again, what it showed
  START_CATCH = 2,       // the rotor turns: current loop closed, estimators following
  START_AXIS = 3,        // zero mean voltage, the axis is found
  START_SETTLE = 4,      // current loop closed at zero
  START_SATURATION = 5,  // polarity by saturation
  START_MOTION = 6,      // polarity by motion
  START_IF_RAMP = 7,     // I-F start: a current vector turns the rotor
  START_CHARGE = 8,      // all lower devices on: bootstrap capacitors
  START_GOES_ON = 9      // none that begins: the phase in hand goes on, or the start is over
} start_phase_t;

typedef struct {
  uint16_t phase;    // start_phase_t: the start is in this one, or ended in it
  uint16_t tick;     // periods since the phase was entered
  uint16_t tries;    // of the present phase
  uint16_t charged;  // periods in which the bootstrap capacitors were charged
  int32_t on_tick;   // of the period in which the gates came on
  axis_t axis;
  saturation_t saturation;
  polarity_t motion;
  followed_t followed;  // the current, what the present test asked of it
  uint16_t held_back;   // how often all began anew
  bool starved;         // the current of a test did not follow: less is tried
  bool uniform;         // the inductances hardly differ, nothing shows the axis at rest
  int32_t sigma_q8;     // confidence in the polarity, standard errors
} drive_start_t;

/// A drive has one start. What it has found stays for those who look.
extern drive_start_t starting;

/// Which ways the start may go, with the configuration: each by the feature that has it.
typedef struct {
  bool listens;        // whether the shaft turns (flying/)
  bool checks_wiring;  // where it was found to stand (flying/)
  bool open_loop;      // a current vector turns one that stands (if_start/)
} start_ways_t;

extern start_ways_t start_ways;

/// As after power-on, and at the beginning of a start.
void start_reset(void);

/// By the phase that begins: it is in hand from this instant on.
void start_enter(start_phase_t phase);
void start_power(drive_t* d, bool on);

/// Asks for the next period for a decision alone; true in that period, which has room for it.
bool start_has_exclusive_slot(drive_t* d);

/// Takes the period's regression where it is valid. True, in a period for the decision, when the axis is known: the
/// model has the inverse inductances, and *axis_bam is how far the axis is from where it was looked for. A current
/// vector that is to turn the rotor needs neither. Too late is a fault.
bool start_sees_axis(drive_t* d, bool valid, int32_t* axis_bam);

/// True where a current vector is to turn the rotor.
bool start_is_open_loop(const drive_t* d);

/// Gates on, current loop open, all estimators at angle zero, as for a shaft that stands. False when the gates were
/// refused, with a fault.
bool start_begin_standstill(drive_t* d);

/// Back from RUN to START, whose phase in hand the caller says; to RUN again, then.
void start_return(drive_t* d);

// What begins where a phase is over.
start_phase_t start_look(const drive_t* d);           // is the shaft to be looked at? Else as if it stood
start_phase_t start_at_standstill(const drive_t* d);  // the shaft stands

/// The start is over: the rotor is here, and no torque current is asked for.
void start_run(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

#endif

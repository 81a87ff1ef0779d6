// What stands above the drive may do with it: commands, parameters, inspection. The console and the bus use these
// calls; so does the test bench. All are called from the background level.

#ifndef STILLSPIN_FIRMWARE_MODE_COMMANDS_H
#define STILLSPIN_FIRMWARE_MODE_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/text/packed_text.h"

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum {
  DRIVE_BOOT = 0,
  DRIVE_CALIBRATE = 1,  // current offsets, power stage off
  DRIVE_READY = 2,
  DRIVE_START = 3,  // initial angle and polarity
  DRIVE_RUN = 4,
  DRIVE_STOP = 5,  // speed to zero, then ready
  DRIVE_FAULT = 6,
  DRIVE_COMMISSION = 7  // measures machine and inverter
} drive_state_t;

#define FAULT(number, name, words, remedy) FAULT_##name = (number),
typedef enum {
#include "firmware/dictionary/fault_list.h"
} drive_fault_t;
#undef FAULT

typedef enum {
  LIMIT_CURRENT = 1,
  LIMIT_VOLTAGE = 2,
  LIMIT_WEAKENING = 4,
  LIMIT_OVERRUN = 8,
  LIMIT_BRAKING = 16  // the DC link takes no more
} drive_limit_t;

#define SIGNAL(name, unit, q, of, value, meaning) int32_t name;
typedef struct {
#include "firmware/dictionary/signal_list.h"
} drive_signals_t;
#undef SIGNAL

/// All signals, as one control interrupt left them, without holding the next one up.
drive_signals_t drive_signals(void);
/// What is known beside the drive's own state.
typedef enum {
  KNOWN_ROTOR = 1,  // angle and speed are the rotor's
  KNOWN_FRAME = 2   // the currents are seen in the frame that the control uses; in a start that need not be the rotor's
} known_t;

typedef struct {
  uint32_t time_ms;  // drive_time_ms
  uint16_t known;    // bits of known_t: signals that need another one are 0 and say nothing
} signals_seen_t;

/// Some of them, given by their places, as one control interrupt left them. Returns what goes with that interrupt.
signals_seen_t drive_signals_copy(const uint16_t* places, uint16_t count, int32_t* values);
/// One of them, by its place in signal_list.h, as it is now; a place that does not exist gives 0. known: as drive_known
/// has it now, asked once for as many as are looked at together.
int32_t drive_signal(uint16_t place, uint16_t known);
/// Whether the signal has a value with that.
bool drive_signal_is_known(uint16_t place, uint16_t known);

typedef struct {
  packed_text_t name, unit, meaning;
  uint16_t q : 8;
  uint16_t needs : 2;  // bit of known_t
} signal_info_t;

uint16_t signal_count(void);
/// NULL behind the last one.
const signal_info_t* signal_info(uint16_t place);

/// Since power-on, by the control interrupt; wraps after 49 days.
uint32_t drive_time_ms(void);
drive_state_t drive_state(void);
bool drive_is_energised(void);

typedef enum { PARAMETER_STOPPED = 0, PARAMETER_ALWAYS = 1 } parameter_access_t;
typedef enum { SET_OK = 0, SET_UNKNOWN = 1, SET_RANGE = 2, SET_RUNNING = 3 } parameter_result_t;

typedef struct {
  uint16_t id;
  uint16_t q : 6;
  uint16_t decimals : 4;
  uint16_t access : 2;  // parameter_access_t
  packed_text_t name, unit, meaning;
  int32_t minimum, maximum, initial;  // raw, with q fractional bits
} parameter_info_t;

uint16_t parameter_count(void);
const parameter_info_t* parameter_info(uint16_t index);
/// By its number; NULL when there is none.
const parameter_info_t* parameter_by_id(uint16_t id);
/// Capitals count as small letters.
const parameter_info_t* parameter_named(const uint16_t* name, uint16_t count);
parameter_result_t parameter_set(uint16_t id, int32_t raw);
int32_t parameter_get(uint16_t id);
/// Why the present parameters cannot be used together, one sentence; PACKED_NONE when they can.
packed_text_t parameter_conflict(void);
/// The same, without a calculation when the background level has made a configuration of them.
packed_text_t parameter_conflict_known(void);

void drive_command_start(void);
/// Speed to zero along the ramp, then gates off; a start procedure is broken off at once.
void drive_command_stop(void);
/// Gates off with the next control interrupt, whatever the speed: the shaft runs out. READY follows.
void drive_command_coast(void);
/// Mechanical speed reference, rpm Q16; clamped to the speed limit. Taken in every state and kept through stop and
/// start, so it may be given before the start; a fault puts it to zero.
void drive_command_speed(int32_t rpm_q16);
/// Clears a latched fault; the drive calibrates its offsets again and is READY.
void drive_command_reset(void);

/// What two short-circuit pulses say of a shaft.
typedef enum {
  LOOK_NONE = 0,     // nobody has looked since power-on
  LOOK_RUNNING = 1,  // under way
  LOOK_TURNS = 2,    // at drive_look_rpm
  LOOK_STANDS = 3,   // or turns more slowly than drive_look_rpm
  LOOK_UNCLEAR = 4,  // the pulses contradict each other; by the size of its EMF alone it turns at drive_look_rpm
  LOOK_ENDED = 5     // by a stop or a fault
} look_outcome_t;

/// From READY, a tenth of a second: short-circuits the motor twice for up to a millisecond. READY follows.
void drive_command_look(void);
look_outcome_t drive_look_outcome(void);
/// Mechanical, Q16; its sign only when it TURNS.
int32_t drive_look_rpm(void);

// Commissioning. It takes a minute and a half, turns the shaft, and ends in READY.

typedef enum {
  COMMISSIONING_IDLE = 0,
  COMMISSIONING_TURN = 1,       // to where no phase is without current
  COMMISSIONING_STAIRCASE = 2,  // resistance, drop, dead time
  COMMISSIONING_SPIN = 3,       // flux linkage, inertia, friction
  COMMISSIONING_MAP = 4,        // inductances against torque current, sensors
  COMMISSIONING_EVALUATE = 5
} commissioning_phase_t;

typedef enum {
  COMMISSIONING_NONE = 0,
  COMMISSIONING_RUNNING = 1,
  COMMISSIONING_DONE = 2,     // every value is plausible and in use
  COMMISSIONING_PARTLY = 3,   // some are not; those keep their old value
  COMMISSIONING_ABORTED = 4,  // by a stop command
  COMMISSIONING_FAILED = 5    // by a fault
} commissioning_outcome_t;

/// Why an identified value is or is not used.
typedef enum {
  VERDICT_USED = 0,
  VERDICT_NOT_MEASURED = 1,  // too few samples
  VERDICT_SPREAD = 2,        // the points do not lie on the curve that is fitted to them
  VERDICT_NAMEPLATE = 3,     // too far from the value so far
  VERDICT_INCONSISTENT = 4,  // two ways to the same value disagree
  VERDICT_RANGE = 5,         // outside of the parameter's range
  VERDICT_NOT_PHYSICAL = 6,  // no machine has this
  VERDICT_DEPENDS = 7        // rests on another value that was refused
} commissioning_verdict_t;

typedef struct {
  uint16_t id;                      // of the parameter
  int32_t before, value;            // raw, in the parameter's format
  commissioning_verdict_t verdict;  // `value` is in use when it is VERDICT_USED
} commissioning_result_t;

/// From READY. A stop command aborts it.
void drive_command_commission(void);
commissioning_outcome_t drive_commissioning_outcome(void);
commissioning_phase_t drive_commissioning_phase(void);
/// Share done, 0..1000.
int32_t drive_commissioning_progress(void);
/// None but when the outcome is DONE or PARTLY.
uint16_t drive_commissioning_count(void);
commissioning_result_t drive_commissioning_result(uint16_t index);

/// Power-on state: clears the drive and puts every parameter to its default. firmware_main does it first.
void drive_reset(void);

/// The image's entry: never returns.
void firmware_main(void);

#if defined(__cplusplus)
}
#endif

#endif

// What stands above the drive may do with it: commands, parameters, inspection. The console and the bus use these
// calls; so does the test bench. All are called from the background level.

#ifndef STILLSPIN_FIRMWARE_DRIVE_API_H
#define STILLSPIN_FIRMWARE_DRIVE_API_H

#include <stdbool.h>
#include <stdint.h>

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
  DRIVE_FAULT = 6
} drive_state_t;

typedef enum {
  FAULT_NONE = 0,
  FAULT_OVER_CURRENT = 1,   // comparator, through the trip zone
  FAULT_CURRENT_LIMIT = 2,  // a sampled phase beyond trip_current
  FAULT_LINK_LOW = 3,
  FAULT_LINK_HIGH = 4,
  FAULT_OVERRUN = 5,       // the control interrupt missed its period repeatedly
  FAULT_NO_SAMPLES = 6,    // the ADC was not triggered
  FAULT_DIVERGENCE = 7,    // the estimators disagree, or the speed is not plausible
  FAULT_POLARITY = 8,      // the polarity of the magnet could not be told, or the back-EMF contradicts it
  FAULT_OFFSET = 9,        // a current offset is implausible
  FAULT_PARAMETER = 10,    // parameters not usable together, or an interrupt that nobody expects
  FAULT_GATES_OFF = 11,    // the gates were switched off behind the drive's back
  FAULT_SYNCHRONISM = 12,  // the angle in use does not fit the machine any more
  FAULT_STOP = 13          // standstill not reached within stop_time
} drive_fault_t;

typedef enum { LIMIT_CURRENT = 1, LIMIT_VOLTAGE = 2, LIMIT_WEAKENING = 4, LIMIT_OVERRUN = 8 } drive_limit_t;

#define SIGNAL(name, unit, q, meaning) int32_t name;
typedef struct {
#include "firmware/signal_list.h"
} drive_signals_t;
#undef SIGNAL

/// A consistent copy is not needed on the bench: call it between interrupts.
const drive_signals_t* drive_signals(void);

typedef enum { PARAMETER_STOPPED = 0, PARAMETER_ALWAYS = 1 } parameter_access_t;
typedef enum { SET_OK = 0, SET_UNKNOWN = 1, SET_RANGE = 2, SET_RUNNING = 3 } parameter_result_t;

typedef struct {
  uint16_t id;
  const char* name;
  const char* unit;
  uint16_t q;
  uint16_t decimals;
  int32_t minimum, maximum, initial;  // raw, with q fractional bits
  parameter_access_t access;
  const char* meaning;
} parameter_info_t;

uint16_t parameter_count(void);
const parameter_info_t* parameter_info(uint16_t index);
parameter_result_t parameter_set(uint16_t id, int32_t raw);
int32_t parameter_get(uint16_t id);
/// Why the present parameters cannot be used together, one sentence; NULL when they can.
const char* parameter_conflict(void);

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

/// Power-on state: clears the drive and puts every parameter to its default. firmware_main does it first.
void drive_reset(void);

/// The image's entry: never returns.
void firmware_main(void);

#if defined(__cplusplus)
}
#endif

#endif

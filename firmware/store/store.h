// Parameter store: the parameters in a memory that keeps them without power (hal/hal_nvm.h).
//
// Two slots, written in turn; the newer valid one counts. A save never touches that one, so wherever the power fails
// either the old or the new set is read next time, as a whole (firmware/store/slot.h has the format). What cannot be
// read is read once more before it is given up; when the slot that is given up may have been the newer one, the state
// says so. Values go by the stable number of their parameter and are rescaled when its format has changed; a value
// outside of its range is refused, its default stays in force; numbers that this firmware does not know are kept and
// written back, so that going to an older firmware or to another edition and back again loses nothing.
//
// store_service does all the work, in the background level and in short slices (below 2000 cycles, but for the exchange
// of a whole set, which checks it like a changed parameter does); it never waits. At power-on it reads while the drive
// stays in BOOT. When no whole and consistent set could be read the values in force stay, which are the defaults at
// power-on, and `state` says why. A save takes the values of the moment in which it is asked for, reads back what it
// has written, and only then makes it valid.
//
// Duration with 86 parameters, measured on the virtual chip: a load 20 ms, of which 5 pass while the converter powers
// up, a save 0.11 s. Wear: a save writes each page of one of the slots once, its first page twice, and the slots take
// turns.

#ifndef STILLSPIN_FIRMWARE_STORE_STORE_H
#define STILLSPIN_FIRMWARE_STORE_STORE_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum {
  STORE_EMPTY = 0,     // a new memory
  STORE_LOADED = 1,    // the values are in force as they were saved
  STORE_DAMAGED = 2,   // something is there, and no slot of it is valid
  STORE_MIGRATED = 3,  // loaded, from another firmware: see store_report
  STORE_SAVING = 4,
  STORE_SAVED = 5,
  STORE_FAILED = 6,    // a save was broken off: the set saved before is still there
  STORE_READING = 7,   // at power-on or on command
  STORE_ABSENT = 8,    // no memory answers: STORE_STATE_ABSENT
  STORE_CONFLICT = 9,  // the saved values do not fit together (parameter_conflict)
  STORE_FOREIGN = 10,  // written in a format of the future
  STORE_OLDER = 11     // loaded, but not what was saved last: that is damaged, broken off or in a format of the future
} store_state_t;

/// What was found at the last loading or written at the last saving.
typedef struct {
  uint16_t slot;           // 0, 1; SLOTS when none is valid
  uint16_t newest;         // the same, also in a format of the future: a save spares it
  bool older;              // the other slot may have been newer
  uint32_t sequence;       // how many times this memory has been written: its wear
  uint16_t values;         // in the slot
  uint16_t rescaled;       // the parameter's format has changed
  uint16_t refused;        // outside of the range: default
  uint16_t first_refused;  // number of the first of them, 0 for none
  uint16_t missing;        // parameters that the slot does not have: default
  uint16_t unknown;        // kept for another firmware
  uint16_t left_out;       // of these, parameters of a feature that this edition has not
  uint16_t damaged;        // slots in which something is that is not valid
} store_report_t;

/// Power-on state: begins to read. The memory must be set up.
void store_begin(void);

/// As without a memory: EMPTY, nothing under way.
void store_reset(void);

/// Background level.
void store_service(void);

/// Begins to save, load. False while either is under way; a load also while the power stage is on.
bool store_save(void);
bool store_load(void);

/// Puts every parameter to its default, in force but not saved. False while the power stage is on or the store is busy.
bool store_defaults(void);

/// How many parameters are not what the next power-on will have; UNSAVED_UNKNOWN behind a save that failed. A
/// value that is set back to the kept one is not among them.
uint16_t store_unsaved(void);

/// Writes into feature_status how it is.
void store_status_update(void);

store_state_t store_state(void);
bool store_is_busy(void);

/// Share of a save or load that is done, 0..100; 100 when none is under way.
uint16_t store_progress(void);

const store_report_t* store_report(void);

#if defined(__cplusplus)
}
#endif

#endif

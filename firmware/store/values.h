// A whole set of parameter values beside the one in force: what is being read, what is to be saved, and between two
// such jobs what is kept.
//
// Values come by the number of their parameter, and from another firmware they may come in another format.

#ifndef STILLSPIN_FIRMWARE_STORE_VALUES_H
#define STILLSPIN_FIRMWARE_STORE_VALUES_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/store/slot.h"

typedef enum {
  VALUE_TAKEN = 0,
  VALUE_RESCALED = 1,  // taken, in this firmware's format
  VALUE_REFUSED = 2,   // outside of the range, or a choice that this edition has not
  VALUE_UNKNOWN = 3    // no such parameter
} value_fate_t;

/// Defaults.
void values_reset(void);

/// The values in force.
void values_copy(void);

value_fate_t values_put(const slot_entry_t* entry);
bool values_know(uint16_t id);

/// Behind the last one. A firmware that knew no rated_current had overload_current 0, watching nothing, where nobody
/// had set it: it becomes that of the motor.
void values_complete(void);

/// Parameter `index` of the table, 0..parameter_count() - 1.
slot_entry_t values_entry(uint16_t index);

/// How many of the values in force differ.
uint16_t values_changed(void);

/// Exchanges this set and the one in force.
void values_swap(void);

#endif

// The parameter values in use, by name. The table itself is parameter_list.h; mode/commands.h has access by id.

#ifndef STILLSPIN_FIRMWARE_DICTIONARY_PARAMETERS_H
#define STILLSPIN_FIRMWARE_DICTIONARY_PARAMETERS_H

#include "firmware/mode/commands.h"

/// One int32_t per parameter, with the table's number of fractional bits.
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) int32_t name;
typedef struct {
#include "firmware/dictionary/parameter_list.h"
} parameters_t;
#undef PARAMETER

extern parameters_t parameters;

/// Values of the parameter position_source.
enum {
  POSITION_ENCODER = 0,
  POSITION_PAPER = 1,         // ZVV and AVV, blended
  POSITION_OBSERVER_AVV = 2,  // the observer at low speed, AVV above
  POSITION_AVV = 3,
  POSITION_OBSERVER = 4,
  POSITION_FLUX_CONV = 5,  // from here on: the observer at low speed, the stator flux above (sources/flux.h)
  POSITION_FLUX_ACTIVE = 8
};

/// Values of the parameter current_law.
enum { CURRENT_LAW_PI = 0, CURRENT_LAW_HYSTERESIS = 1 };

/// Puts every parameter to its default.
void parameters_reset(void);

#endif

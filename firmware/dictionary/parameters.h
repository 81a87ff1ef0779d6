// The parameter values in use, by name. The table itself is parameter_list.h.

#ifndef STILLSPIN_FIRMWARE_DICTIONARY_PARAMETERS_H
#define STILLSPIN_FIRMWARE_DICTIONARY_PARAMETERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "firmware/text/packed_text.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// One int32_t per parameter, with the table's number of fractional bits, in units of the formats (units.h).
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) int32_t name;
typedef struct {
#include "firmware/dictionary/all_parameters.h"
} parameters_t;
#undef PARAMETER

extern parameters_t parameters;

/// The struct is an array with names: what stands side by side in the list is read in a loop.
#define PARAMETER_PLACES (sizeof(parameters_t) / sizeof(int32_t))
#define PARAMETER_PLACE(name) ((uint16_t)(offsetof(parameters_t, name) / sizeof(int32_t)))
static inline int32_t parameter_at(uint16_t place) { return ((const int32_t*)(const void*)&parameters)[place]; }

/// Values of the parameter position_source.
enum {
  POSITION_ENCODER = 0,
  POSITION_PAPER = 1,         // ZVV and AVV, blended
  POSITION_OBSERVER_AVV = 2,  // the observer at low speed, AVV above
  POSITION_AVV = 3,
  POSITION_OBSERVER = 4,
  POSITION_FLUX_CONV = 5,  // from here on: the observer at low speed, the stator flux above (sources/flux/)
  POSITION_FLUX_ACTIVE = 8
};

/// Values of the parameter current_law.
enum { CURRENT_LAW_PI = 0, CURRENT_LAW_HYSTERESIS = 1 };

typedef enum { PARAMETER_STOPPED = 0, PARAMETER_ALWAYS = 1 } parameter_access_t;
typedef enum { SET_OK = 0, SET_UNKNOWN = 1, SET_RANGE = 2, SET_RUNNING = 3 } parameter_result_t;

typedef struct {
  uint16_t id : 10;
  uint16_t access : 1;       // parameter_access_t
  uint16_t unit : 5;         // unit_t
  uint16_t q : 5;            // in the formats; in user's units parameter_q
  uint16_t decimals : 3;     // likewise parameter_decimals
  uint16_t minimum : 8;      // packed: parameter_minimum and the others have them
  int16_t maximum, initial;  // likewise
} parameter_info_t;

/// Those of the edition, in the order of the list.
uint16_t parameter_count(void);
const parameter_info_t* parameter_info(uint16_t index);
packed_text_t parameter_name(const parameter_info_t* p);
packed_text_t parameter_unit(const parameter_info_t* p);
/// Fractional bits and decimals in user's units (units.h).
uint16_t parameter_q(const parameter_info_t* p);
uint16_t parameter_decimals(const parameter_info_t* p);
packed_text_t parameter_meaning(const parameter_info_t* p);
/// Raw, with q fractional bits.
int32_t parameter_minimum(const parameter_info_t* p);
int32_t parameter_maximum(const parameter_info_t* p);
int32_t parameter_initial(const parameter_info_t* p);
/// Within the two.
bool parameter_allows(const parameter_info_t* p, int32_t raw);
/// The value in a set of them, index 0 .. parameter_count() - 1.
int32_t* parameter_value(parameters_t* of, uint16_t index);
/// By its number; NULL when there is none.
const parameter_info_t* parameter_by_id(uint16_t id);
/// Capitals count as small letters.
const parameter_info_t* parameter_named(const uint16_t* name, uint16_t count);
/// Where its value in use is. Nothing is checked of what is written there: see parameter_set in mode/commands.h.
int32_t* parameter_in_use(const parameter_info_t* p);
/// The value in use by its number; 0 when there is none.
int32_t parameter_get(uint16_t id);

/// Of a feature that this edition has not: it stays at its default.
bool parameter_is_left_out(uint16_t id);

/// Puts every parameter to its default, those as well that the edition has not.
void parameters_reset(parameters_t* of);

#if defined(__cplusplus)
}
#endif

#endif

// What an ampere and a volt of the formats are. A drive for 600 A and one for 2 A differ in their board's sensors, not
// in what is reckoned: all equations of machine, control and estimators keep their form when currents, voltages and
// what is made of the two are counted in other units and time is not. The formats count in units of 2^current_scale A
// and 2^voltage_scale V; users, files and buses see amperes and volts.

#ifndef STILLSPIN_FIRMWARE_DICTIONARY_UNITS_H
#define STILLSPIN_FIRMWARE_DICTIONARY_UNITS_H

#include <stdint.h>

#include "firmware/base/octets.h"
#include "firmware/text/packed_text.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define UNIT(unit, text, current, voltage) UNIT_##unit,
typedef enum {
#include "firmware/dictionary/unit_list.h"
  UNITS
} unit_t;
#undef UNIT

/// Decimals that put_fixed takes at most.
#define UNIT_DECIMALS_MAX 9

/// A value in user's units is one of the formats times two to this, -28 .. 28.
int16_t unit_exponent(uint16_t unit);
/// Fractional bits in user's units of a value with q of them in the formats. Not below 0 for any row of the tables.
uint16_t unit_q(uint16_t unit, uint16_t q);
/// As many decimals as show in user's units what `decimals` of the formats show, UNIT_DECIMALS_MAX at most.
uint16_t unit_decimals(uint16_t unit, uint16_t decimals);
/// A number that changes when a scale does.
uint16_t unit_scales(void);
static inline packed_text_t unit_text(uint16_t unit) { return (packed_text_t)(TEXT_UNIT_A + unit); }
/// A space and the unit, nothing of a number that has none.
void put_unit(octet_writer_t* w, packed_text_t unit);
/// The number in user's units, without the unit.
void put_quantity(octet_writer_t* w, int32_t raw, uint16_t unit, uint16_t q, uint16_t decimals);

#if defined(__cplusplus)
}
#endif

#endif

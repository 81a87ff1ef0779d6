#include "firmware/dictionary/units.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/text/text.h"
#include "hal/qmath/qmath.h"

// Both powers of a unit, -1 .. 2, as octets of a word.
#define UNIT(unit, text, current, voltage) (int16_t)((current) * 256 + (voltage)),
static const int16_t powers[UNITS] = {
#include "firmware/dictionary/unit_list.h"
};
#undef UNIT

int16_t unit_exponent(uint16_t unit) {
  const int16_t current = (int16_t)q_shr(powers[unit] + 128, 8);
  const int16_t voltage = (int16_t)(powers[unit] - current * 256);
  return (int16_t)(current * (int16_t)parameters.current_scale + voltage * (int16_t)parameters.voltage_scale);
}

uint16_t unit_q(uint16_t unit, uint16_t q) { return (uint16_t)((int16_t)q - unit_exponent(unit)); }

// A decimal digit is worth 3.3 bits.
uint16_t unit_decimals(uint16_t unit, uint16_t decimals) {
  const int16_t finer = (int16_t)-unit_exponent(unit);
  const uint16_t more = (finer > 0) ? (uint16_t)((finer * 3 + 9) / 10) : 0u;
  return (uint16_t)q_min16((int16_t)(decimals + more), UNIT_DECIMALS_MAX);
}

uint16_t unit_scales(void) {
  return (uint16_t)((uint16_t)parameters.current_scale * 16u + (uint16_t)parameters.voltage_scale);
}

void put_quantity(octet_writer_t* w, int32_t raw, uint16_t unit, uint16_t q, uint16_t decimals) {
  put_fixed(w, raw, unit_q(unit, q), unit_decimals(unit, decimals));
}

void put_unit(octet_writer_t* w, packed_text_t unit) {
  if (packed_is_empty(unit)) return;
  put_u8(w, ' ');
  put_packed(w, unit);
}

// Numbers as people write them, to and from fixed point, without a C library. Text is written by the octet writer of
// link/octets.h.
//
// Conversions are exact: a written number is the nearest one with so many decimals (halves away from zero), a read one
// the nearest raw value.

#ifndef STILLSPIN_FIRMWARE_TEXT_TEXT_H
#define STILLSPIN_FIRMWARE_TEXT_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define TEXT_DECIMALS_MAX 9u

void put_unsigned(octet_writer_t* w, uint32_t value);
/// With zeros in front where there are fewer digits, 1 to 10.
void put_digits(octet_writer_t* w, uint32_t value, uint16_t digits);

/// raw / 2^q with so many decimals; q = 0..40, decimals = 0..9.
void put_fixed(octet_writer_t* w, int32_t raw, uint16_t q, uint16_t decimals);

/// Fills up with spaces to a column, counted from where the line began in the block.
void put_spaces_to(octet_writer_t* w, uint16_t column);

/// 10^k, k = 0..9.
extern const int32_t powers_of_ten[];

/// A number of decimal digits: digits / 10^decimals.
typedef struct {
  int32_t digits;
  uint16_t decimals;  // 0..9
} decimal_t;

/// Reads [+-]digits[.digits][e[+-]digits] at the beginning of `count` characters. Returns how many characters the
/// number has; 0 when there is none, or when a comma or a second point is behind it. What does not fit 31 bits becomes
/// the largest number, which decimal_raw refuses; digits beyond the ninth, or the tenth, count
/// as zeros.
uint16_t text_number(const uint16_t* text, uint16_t count, decimal_t* number);

bool decimal_is_whole(const decimal_t* number);

/// Nearest raw value with q fractional bits (0..40). False when it does not fit, or is the last one that would.
bool decimal_raw(const decimal_t* number, uint16_t q, int32_t* raw);

/// The small letter of a capital; any other character itself.
uint16_t text_small(uint16_t c);

#if defined(__cplusplus)
}
#endif

#endif

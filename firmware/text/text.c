#include "firmware/text/text.h"

#include "hal/qmath/qcall.h"
#include "hal/qmath/qmath.h"

#define EXPONENT_ENOUGH 100u  // for everything else to be beyond all formats

const int32_t powers_of_ten[] = {1L, 10L, 100L, 1000L, 10000L, 100000L, 1000000L, 10000000L, 100000000L, 1000000000L};

void put_digits(octet_writer_t* w, uint32_t value, uint16_t digits) {
  uint16_t reversed[10];
  uint16_t count = 0;
  while (value > 0u || count < digits) {
    reversed[count++] = (uint16_t)('0' + value % 10u);
    value /= 10u;
  }
  while (count > 0u) put_u8(w, reversed[--count]);
}

void put_unsigned(octet_writer_t* w, uint32_t value) { put_digits(w, value, 1); }

void put_fixed(octet_writer_t* w, int32_t raw, uint16_t q, uint16_t decimals) {
  const uint32_t magnitude = q_abs_u32(raw);
  uint32_t whole = (uint32_t)((uint64_t)magnitude >> q);
  const uint64_t rest = magnitude - ((uint64_t)whole << q);
  const uint32_t halves = (uint32_t)((rest * (2u * (uint32_t)powers_of_ten[decimals])) >> q);
  uint32_t fraction = (halves + 1u) / 2u;
  if (fraction >= (uint32_t)powers_of_ten[decimals]) {
    fraction = 0;
    whole++;
  }
  if (raw < 0 && (whole | fraction) != 0u) put_u8(w, '-');
  put_unsigned(w, whole);
  if (decimals == 0u) return;
  put_u8(w, '.');
  put_digits(w, fraction, decimals);
}

void put_spaces_to(octet_writer_t* w, uint16_t column) {
  do {
    put_u8(w, ' ');
  } while (w->count < column && !w->full);
}

static bool is_digit(uint16_t c) { return c >= '0' && c <= '9'; }

// One digit more; false, and nothing changed, when it does not fit.
static bool append(decimal_t* number, uint16_t c) {
  if (number->digits > INT32_MAX / 10) return false;
  const uint32_t more = (uint32_t)number->digits * 10u + (uint16_t)(c - '0');
  if (more > (uint32_t)INT32_MAX) return false;
  number->digits = (int32_t)more;
  return true;
}

// The digits and the point from `at` on; returns the place behind them. `scale` is the power of ten of the last digit
// that was taken, `seen` how many there are.
static uint16_t read_digits(const uint16_t* text, uint16_t at, uint16_t count, decimal_t* number, int16_t* scale,
                            uint16_t* seen) {
  bool behind_point = false;
  bool full = false;
  for (; at < count; at++) {
    if (!behind_point && text[at] == '.') {
      behind_point = true;
      continue;
    }
    if (!is_digit(text[at])) break;
    (*seen)++;
    full = full || !append(number, text[at]);
    if (full != behind_point) *scale = (int16_t)(full ? *scale + 1 : *scale - 1);
  }
  return at;
}

// Behind an e, when digits follow; the place behind them, or `at` when this is no exponent but a unit.
static uint16_t read_exponent(const uint16_t* text, uint16_t at, uint16_t count, int16_t* exponent) {
  uint16_t end = (uint16_t)(at + 1u);
  uint16_t power = 0;
  *exponent = 0;
  if (at >= count || text_small(text[at]) != 'e') return at;
  const bool negative = end < count && text[end] == '-';
  if (end < count && (text[end] == '-' || text[end] == '+')) end++;
  if (end >= count || !is_digit(text[end])) return at;
  for (; end < count && is_digit(text[end]); end++) {
    if (power < EXPONENT_ENOUGH) power = (uint16_t)(power * 10u + ((text[end] - (uint16_t)'0') & 15u));
  }
  *exponent = (int16_t)(negative ? -(int16_t)power : (int16_t)power);
  return end;
}

static void apply_scale(decimal_t* number, int32_t scale) {
  for (; scale > 0 && number->digits > 0; scale--) {
    if (append(number, '0')) continue;
    number->digits = INT32_MAX;
    break;
  }
  for (; scale < -(int32_t)TEXT_DECIMALS_MAX; scale++) number->digits /= 10;
  number->decimals = (scale < 0) ? (uint16_t)-scale : 0u;
}

uint16_t text_number(const uint16_t* text, uint16_t count, decimal_t* number) {
  int16_t scale = 0;
  int16_t exponent = 0;
  uint16_t seen = 0;
  const bool negative = count > 0u && text[0] == '-';
  const uint16_t first = (negative || (count > 0u && text[0] == '+')) ? 1u : 0u;
  number->digits = 0;
  number->decimals = 0;
  uint16_t at = read_digits(text, first, count, number, &scale, &seen);
  if (seen == 0u) return 0;
  at = read_exponent(text, at, count, &exponent);
  apply_scale(number, (int32_t)scale + exponent);
  if (negative) number->digits = -number->digits;
  return (at < count && (text[at] == ',' || text[at] == '.')) ? 0u : at;
}

bool decimal_is_whole(const decimal_t* number) { return number->digits % powers_of_ten[number->decimals] == 0; }

bool decimal_raw(const decimal_t* number, uint16_t q, int32_t* raw) {
  const uint16_t beyond = (q > 31u) ? (uint16_t)(q - 31u) : 0u;
  const int32_t one = powers_of_ten[number->decimals];
  const int32_t most = INT32_MAX >> beyond;
  *raw = number->digits;
  if (*raw > most || *raw < -most) return false;
  *raw = q_div(*raw * ((int32_t)1 << beyond), one, (uint16_t)(q - beyond));
  return qc_abs_sat(*raw) < INT32_MAX;
}

uint16_t text_small(uint16_t c) { return (c >= 'A' && c <= 'Z') ? (uint16_t)(c + 32u) : c; }

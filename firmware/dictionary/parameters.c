#include "firmware/dictionary/parameters.h"

#include <stddef.h>

#include "firmware/base/edition.h"
#include "hal/hal_board.h"

parameters_t parameters;

// 10^n and the exact conversion of a decimal value to a raw one, in integers so that every compiler agrees.
#define TEN_0 1LL
#define TEN_1 10LL
#define TEN_2 100LL
#define TEN_3 1000LL
#define TEN_4 10000LL
#define TEN_5 100000LL
#define TEN_6 1000000LL
#define RAW(value, q, ten) \
  (int32_t)((((value) < 0 ? -1LL : 1LL) * (ten) / 2 + (long long)(value) * (1LL << (q))) / (ten))

#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  {id,                                                                                     \
   q,                                                                                      \
   decimals,                                                                               \
   PARAMETER_##access,                                                                     \
   RAW(minimum, q, TEN_##decimals),                                                        \
   RAW(maximum, q, TEN_##decimals),                                                        \
   RAW(initial, q, TEN_##decimals)},
static const parameter_info_t table[] = {
#include "firmware/dictionary/parameter_list.h"
};
#undef PARAMETER

#define COUNT ((uint16_t)(sizeof table / sizeof table[0]))

// Texts stand in the table's order, whose first row this is.
#define FIRST(what) TEXT_PARAMETER_##what##pole_pairs

static packed_text_t text_of(const parameter_info_t* p, uint16_t first) {
  return (packed_text_t)(first + (uint16_t)(p - table));
}

packed_text_t parameter_name(const parameter_info_t* p) { return text_of(p, FIRST(NAME_)); }
packed_text_t parameter_unit(const parameter_info_t* p) { return text_of(p, FIRST(UNIT_)); }
packed_text_t parameter_meaning(const parameter_info_t* p) { return text_of(p, FIRST()); }

// The values stand in the table's order: the struct is an array with names.
typedef char values_are_an_array[(sizeof(parameters_t) == COUNT * sizeof(int32_t)) ? 1 : -1];
static int32_t* value_of(parameters_t* of, uint16_t row) { return &((int32_t*)(void*)of)[row]; }

// The row of a parameter by its place among those of the edition.
static uint16_t row_of(uint16_t index) {
  for (const rows_t* gone = edition_parameters_left_out; gone->count > 0u && gone->first <= index; gone++) {
    index = (uint16_t)(index + gone->count);
  }
  return index;
}

void parameters_reset(void) {
  for (uint16_t k = 0; k < COUNT; k++) *value_of(&parameters, k) = table[k].initial;
}

uint16_t parameter_count(void) {
  uint16_t count = COUNT;
  for (const rows_t* gone = edition_parameters_left_out; gone->count > 0u; gone++)
    count = (uint16_t)(count - gone->count);
  return count;
}

const parameter_info_t* parameter_info(uint16_t index) {
  return (index < parameter_count()) ? &table[row_of(index)] : NULL;
}

int32_t* parameter_value(parameters_t* of, uint16_t index) { return value_of(of, row_of(index)); }

static bool is_here(uint16_t row) { return row < COUNT && !rows_have(edition_parameters_left_out, row); }

static uint16_t row_by_id(uint16_t id) {
  uint16_t k = 0;
  while (k < COUNT && table[k].id != id) k++;
  return k;
}

static uint16_t row_by_name(const uint16_t* name, uint16_t count) {
  return packed_find(FIRST(NAME_), COUNT, name, count);
}

const parameter_info_t* parameter_named(const uint16_t* name, uint16_t count) {
  const uint16_t row = row_by_name(name, count);
  return is_here(row) ? &table[row] : NULL;
}

const parameter_info_t* parameter_by_id(uint16_t id) {
  const uint16_t row = row_by_id(id);
  return is_here(row) ? &table[row] : NULL;
}

bool parameter_is_left_out(uint16_t id) {
  for (const rows_t* gone = edition_parameters_left_out; gone->count > 0u; gone++) {
    for (uint16_t k = 0; k < gone->count; k++) {
      if (table[gone->first + k].id == id) return true;
    }
  }
  return false;
}

bool parameter_name_is_left_out(const uint16_t* name, uint16_t count) {
  return rows_have(edition_parameters_left_out, row_by_name(name, count));
}

void parameter_write(uint16_t id, int32_t raw) {
  const uint16_t k = row_by_id(id);
  if (is_here(k)) *value_of(&parameters, k) = raw;
}

int32_t parameter_get(uint16_t id) {
  const uint16_t k = row_by_id(id);
  return (k < COUNT) ? *value_of(&parameters, k) : 0;
}

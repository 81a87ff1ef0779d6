#include "firmware/dictionary/parameters.h"

#include <stddef.h>

#include "firmware/base/edition.h"
#include "firmware/dictionary/units.h"
#include "firmware/text/text.h"
#include "hal/hal_board.h"
#include "hal/qmath/qdiv.h"

parameters_t parameters;

// A number of the list, decimals without a point, as a word: thirteen bits of a step; a minimum as an octet: five bits,
// from LEAST on. What no step has does not compile.
static const int32_t steps[8] = {1, 10, 25, 100, 1000, 1024, 1200, 100000};
#define LEAST (-15)
#define OF(value, step, half) ((value) % (step) == 0 && (value) / (step) >= -(half) + 1L && (value) / (step) <= (half))
#define STEP(value, half)         \
  (OF(value, 1L, half)        ? 0 \
   : OF(value, 10L, half)     ? 1 \
   : OF(value, 25L, half)     ? 2 \
   : OF(value, 100L, half)    ? 3 \
   : OF(value, 1000L, half)   ? 4 \
   : OF(value, 1024L, half)   ? 5 \
   : OF(value, 1200L, half)   ? 6 \
   : OF(value, 100000L, half) ? 7 \
                              : 8)
#define SIZE(step)       \
  ((step) == 0   ? 1L    \
   : (step) == 1 ? 10L   \
   : (step) == 2 ? 25L   \
   : (step) == 3 ? 100L  \
   : (step) == 4 ? 1000L \
   : (step) == 5 ? 1024L \
   : (step) == 6 ? 1200L \
                 : 100000L)
#define STEPS(value, half) ((value) / SIZE(STEP(value, half)))
#define WORD(value) ((int16_t)(STEPS(value, 4095L) * 8L + STEP(value, 4095L)))
#define OCTET(value) ((uint16_t)((STEPS(value, 16L) - LEAST) * 8L + STEP(value, 16L)))

#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  typedef char name##_fits                                                                 \
      [(STEP(minimum, 16L) < 8 && STEP(maximum, 4095L) < 8 && STEP(initial, 4095L) < 8 && (decimals) <= 6) ? 1 : -1];
#include "firmware/dictionary/all_parameters.h"
#undef PARAMETER

#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  {id, PARAMETER_##access, UNIT_##unit, q, decimals, OCTET(minimum), WORD(maximum), WORD(initial)},
static const parameter_info_t table[] = {
#include "firmware/dictionary/all_parameters.h"
};
#undef PARAMETER

#define COUNT ((uint16_t)(sizeof table / sizeof table[0]))

// Texts stand in the table's order, whose first row this is.
#define FIRST(what) TEXT_PARAMETER_##what##pole_pairs

static packed_text_t text_of(const parameter_info_t* p, uint16_t first) {
  return (packed_text_t)(first + (uint16_t)(p - table));
}

packed_text_t parameter_name(const parameter_info_t* p) { return text_of(p, FIRST(NAME_)); }
packed_text_t parameter_unit(const parameter_info_t* p) { return unit_text(p->unit); }
packed_text_t parameter_meaning(const parameter_info_t* p) { return text_of(p, FIRST()); }

uint16_t parameter_q(const parameter_info_t* p) { return unit_q(p->unit, p->q); }
uint16_t parameter_decimals(const parameter_info_t* p) { return unit_decimals(p->unit, p->decimals); }

// So many steps; `step`: which.
static int32_t raw_of(const parameter_info_t* p, int32_t count, int16_t step) {
  return q_div(count * steps[step & 7], powers_of_ten[p->decimals], p->q);
}

static int32_t raw_of_word(const parameter_info_t* p, int16_t word) { return raw_of(p, q_shr(word, 3), word); }

int32_t parameter_minimum(const parameter_info_t* p) {
  return raw_of(p, (int32_t)(p->minimum >> 3) + LEAST, (int16_t)p->minimum);
}

int32_t parameter_maximum(const parameter_info_t* p) { return raw_of_word(p, p->maximum); }
int32_t parameter_initial(const parameter_info_t* p) { return raw_of_word(p, p->initial); }

bool parameter_allows(const parameter_info_t* p, int32_t raw) {
  return raw >= parameter_minimum(p) && raw <= parameter_maximum(p);
}

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

void parameters_reset(parameters_t* of) {
  for (uint16_t k = 0; k < COUNT; k++) *value_of(of, k) = parameter_initial(&table[k]);
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

const parameter_info_t* parameter_named(const uint16_t* name, uint16_t count) {
  const uint16_t row = packed_find(FIRST(NAME_), COUNT, name, count);
  return is_here(row) ? &table[row] : NULL;
}

const parameter_info_t* parameter_by_id(uint16_t id) {
  const uint16_t row = row_by_id(id);
  return is_here(row) ? &table[row] : NULL;
}

bool parameter_is_left_out(uint16_t id) { return rows_have(edition_parameters_left_out, row_by_id(id)); }

int32_t* parameter_in_use(const parameter_info_t* p) { return value_of(&parameters, (uint16_t)(p - table)); }

int32_t parameter_get(uint16_t id) {
  const uint16_t k = row_by_id(id);
  return (k < COUNT) ? *value_of(&parameters, k) : 0;
}

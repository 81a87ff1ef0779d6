#include "firmware/store/values.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"

#define Q_MAX 31u  // fractional bits of a 32-bit number

static struct {
  bool has_rated_current;  // the set has a rated_current of its own
  uint16_t guess;          // where the next number is likely to be: a slot has them in the table's order
  parameters_t set;
} self;

// Index of a parameter, parameter_count() when there is none.
static uint16_t find(uint16_t id) {
  const uint16_t count = parameter_count();
  for (uint16_t k = 0; k < count; k++) {
    const uint16_t index = (uint16_t)((self.guess + k) % count);
    if (parameter_info(index)->id != id) continue;
    self.guess = (uint16_t)((index + 1u) % count);
    return index;
  }
  return count;
}

void values_reset(void) {
  self.guess = 0;
  self.has_rated_current = false;
  parameters_reset(&self.set);
}

void values_copy(void) {
  self.guess = 0;
  self.set = parameters;
}

bool values_know(uint16_t id) { return find(id) < parameter_count(); }

// raw with so many fractional bits more, or fewer; exact halves upward. No range reaches to where it saturates.
static int32_t rescaled(int32_t raw, int16_t more) {
  return (more >= 0) ? qc_shl_sat(raw, (unsigned)more) : q_shr_round(raw, (unsigned)-more);
}

value_fate_t values_put(const slot_entry_t* entry) {
  const uint16_t index = find(entry->id);
  if (index >= parameter_count()) return VALUE_UNKNOWN;
  const parameter_info_t* const info = parameter_info(index);
  if (entry->q > Q_MAX) return VALUE_REFUSED;
  const int16_t more = (int16_t)((int16_t)info->q - (int16_t)entry->q);
  const int32_t raw = rescaled(entry->raw, more);
  // A limit in the coarser of two formats may be one step beyond that in the finer one.
  const int32_t slack = (more == 0) ? 0 : qc_shl_sat(1, (unsigned)q_max(more, 0));
  const int32_t least = parameter_minimum(info);
  const int32_t most = parameter_maximum(info);
  if (raw < qc_sub_sat(least, slack) || raw > qc_add_sat(most, slack)) return VALUE_REFUSED;
  int32_t* const place = parameter_value(&self.set, index);
  const int32_t before = *place;
  *place = q_clamp(raw, least, most);
  if (drive_source_is_left_out(&self.set)) {
    *place = before;
    return VALUE_REFUSED;
  }
  if (place == &self.set.rated_current) self.has_rated_current = true;
  return (more == 0) ? VALUE_TAKEN : VALUE_RESCALED;
}

void values_complete(void) {
  if (!self.has_rated_current && self.set.overload_current == 0) self.set.overload_current = -1;
}

slot_entry_t values_entry(uint16_t index) {
  const parameter_info_t* const info = parameter_info(index);
  const slot_entry_t entry = {info->id, info->q, *parameter_value(&self.set, index)};
  return entry;
}

// What this edition has not is at its default in both sets.
static int32_t* all_of(parameters_t* of) { return (int32_t*)(void*)of; }

uint16_t values_changed(void) {
  uint16_t changed = 0;
  for (uint16_t k = 0; k < PARAMETER_PLACES; k++) {
    if (all_of(&parameters)[k] != all_of(&self.set)[k]) changed++;
  }
  return changed;
}

void values_swap(void) {
  for (uint16_t k = 0; k < PARAMETER_PLACES; k++) {
    const int32_t kept = all_of(&parameters)[k];
    all_of(&parameters)[k] = all_of(&self.set)[k];
    all_of(&self.set)[k] = kept;
  }
}

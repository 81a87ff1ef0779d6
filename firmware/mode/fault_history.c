#include "firmware/mode/fault_history.h"

#include "firmware/mode/states.h"

static volatile fault_record_t ring[FAULT_HISTORY_DEPTH];
static volatile uint16_t written;  // records since power-on, wraps: the next one's place
static volatile uint16_t total;    // the same for people: stays at its end

void fault_history_reset(void) {
  written = 0;
  total = 0;
}

void fault_history_add(const fault_record_t* record) {
  ring[written & (FAULT_HISTORY_DEPTH - 1u)] = *record;
  written = (uint16_t)(written + 1u);
  if (total < UINT16_MAX) total = (uint16_t)(total + 1u);
}

uint16_t fault_history_total(void) { return total; }

bool fault_history_read(uint16_t age, fault_record_t* record) {
  uint16_t seen;
  do {
    if (age >= total || age >= FAULT_HISTORY_DEPTH) return false;
    seen = written;
    *record = ring[(uint16_t)(seen - 1u - age) & (FAULT_HISTORY_DEPTH - 1u)];
  } while (seen != written);
  return true;
}

#include "firmware/mode/fault_history.h"

#include "firmware/mode/states.h"

static volatile struct {
  uint16_t written;  // records since power-on, wraps: the next one's place
  uint16_t total;    // the same for people: stays at its end
  fault_record_t ring[FAULT_HISTORY_DEPTH];
} self;

void fault_history_reset(void) {
  self.written = 0;
  self.total = 0;
}

void fault_history_add(const fault_record_t* record) {
  self.ring[self.written & (FAULT_HISTORY_DEPTH - 1u)] = *record;
  self.written = (uint16_t)(self.written + 1u);
  if (self.total < UINT16_MAX) self.total = (uint16_t)(self.total + 1u);
}

uint16_t fault_history_total(void) { return self.total; }

bool fault_history_read(uint16_t age, fault_record_t* record) {
  uint16_t seen;
  do {
    if (age >= self.total || age >= FAULT_HISTORY_DEPTH) return false;
    seen = self.written;
    *record = self.ring[(uint16_t)(seen - 1u - age) & (FAULT_HISTORY_DEPTH - 1u)];
  } while (seen != self.written);
  return true;
}

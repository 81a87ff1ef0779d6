// The table of the signals, and looking at several of one control interrupt.

#include <stddef.h>

#include "firmware/drive.h"

#define SIGNAL(name, unit, q, meaning) {#name, unit, q, meaning},
static const signal_info_t table[] = {
#include "firmware/signal_list.h"
};
#undef SIGNAL

#define SIGNAL(name, unit, q, meaning) &drive.signals.name,
static const volatile int32_t* const values[] = {
#include "firmware/signal_list.h"
};
#undef SIGNAL

#define COUNT ((uint16_t)(sizeof table / sizeof table[0]))

uint16_t signal_count(void) { return COUNT; }

const signal_info_t* signal_info(uint16_t place) { return (place < COUNT) ? &table[place] : NULL; }

// The interrupt runs as a whole between two instructions of this level: if it has not counted on, it has not been here.
uint32_t drive_signals_copy(const uint16_t* places, uint16_t count, int32_t* copy) {
  const volatile uint16_t* const interrupts = &drive.heartbeat;
  const volatile uint32_t* const clock = &drive.time_ms;
  uint16_t seen;
  uint32_t time_ms;
  do {
    seen = *interrupts;
    time_ms = *clock;
    for (uint16_t k = 0; k < count; k++) copy[k] = (places[k] < COUNT) ? *values[places[k]] : 0;
  } while (seen != *interrupts);
  return time_ms;
}

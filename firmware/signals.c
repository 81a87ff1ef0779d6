// The table of the signals, and looking at several of one control interrupt. Nothing is copied while nobody looks.

#include <stddef.h>

#include "firmware/drive.h"

#define SIGNAL(name, unit, q, value, meaning) {TEXT_SIGNAL_NAME_##name, TEXT_SIGNAL_UNIT_##name, TEXT_SIGNAL_##name, q},
static const signal_info_t table[] = {
#include "firmware/signal_list.h"
};
#undef SIGNAL

// Volatile: to the background level the interrupt changes the drive at any time.
#define SIGNAL_RPM(speed_bpp) q_mul_sat(speed_bpp, d->config.rpm_per_bpp_q40, 24)
#define SIGNAL(name, unit, q, value, meaning) \
  static int32_t look_at_##name(const volatile drive_t* d) { return (int32_t)(value); }
#include "firmware/signal_list.h"
#undef SIGNAL

#define SIGNAL(name, unit, q, value, meaning) look_at_##name,
static int32_t (*const looks[])(const volatile drive_t* d) = {
#include "firmware/signal_list.h"
};
#undef SIGNAL

#define COUNT ((uint16_t)(sizeof table / sizeof table[0]))

uint16_t signal_count(void) { return COUNT; }

const signal_info_t* signal_info(uint16_t place) { return (place < COUNT) ? &table[place] : NULL; }

int32_t drive_signal(uint16_t place) { return (place < COUNT) ? looks[place](&drive) : 0; }

// The interrupt runs as a whole between two instructions of this level: if it has not counted on, it has not been here.
uint32_t drive_signals_copy(const uint16_t* places, uint16_t count, int32_t* copy) {
  const volatile uint16_t* const interrupts = &drive.heartbeat;
  const volatile uint32_t* const clock = &drive.time_ms;
  uint16_t seen;
  uint32_t time_ms;
  do {
    seen = *interrupts;
    time_ms = *clock;
    for (uint16_t k = 0; k < count; k++) copy[k] = drive_signal(places[k]);
  } while (seen != *interrupts);
  return time_ms;
}

drive_signals_t drive_signals(void) {
  const volatile uint16_t* const interrupts = &drive.heartbeat;
  drive_signals_t s;
  uint16_t seen;
  do {
    seen = *interrupts;
#define SIGNAL(name, unit, q, value, meaning) s.name = look_at_##name(&drive);
#include "firmware/signal_list.h"
#undef SIGNAL
  } while (seen != *interrupts);
  return s;
}

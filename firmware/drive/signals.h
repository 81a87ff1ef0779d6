// What may be looked at, and how: by the background level, without holding the control interrupt up.

#ifndef STILLSPIN_FIRMWARE_DRIVE_SIGNALS_H
#define STILLSPIN_FIRMWARE_DRIVE_SIGNALS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "firmware/dictionary/units.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define SIGNAL(name, unit, q, of, value, meaning) int32_t name;
typedef struct {
#include "firmware/dictionary/all_signals.h"
} drive_signals_t;
#undef SIGNAL

/// The struct is an array with names.
#define SIGNAL_PLACE(name) ((uint16_t)(offsetof(drive_signals_t, name) / sizeof(int32_t)))

/// All signals, as one control interrupt left them, without holding the next one up.
drive_signals_t drive_signals(void);
typedef struct {
  uint32_t time_ms;  // drive_time_ms
  uint16_t known;    // bits of known_t: signals that need another one are 0 and say nothing
} signals_seen_t;

/// Some of them, given by their places in signal_list.h (one that does not exist gives 0), as one control interrupt
/// left them. Returns what goes with that interrupt.
signals_seen_t drive_signals_copy(const uint16_t* places, uint16_t count, int32_t* values);

typedef struct {
  packed_text_t name;
  uint16_t q : 8;      // in the formats; in user's units signal_q
  uint16_t needs : 3;  // bit of known_t
  uint16_t unit : 5;   // unit_t
} signal_info_t;

static inline packed_text_t signal_unit(const signal_info_t* s) { return unit_text(s->unit); }
/// Fractional bits in user's units.
static inline uint16_t signal_q(const signal_info_t* s) { return unit_q(s->unit, s->q); }
// The texts of all signals stand in the same order.
static inline packed_text_t signal_meaning(const signal_info_t* s) {
  return (packed_text_t)(s->name - (uint16_t)TEXT_SIGNAL_NAME_speed + (uint16_t)TEXT_SIGNAL_speed);
}

uint16_t signal_count(void);
/// The place of a name, left out or not; signal_count() when there is none. Capitals count as small letters.
uint16_t signal_named(const uint16_t* name, uint16_t count);
/// Of a feature that this edition has not: it has a place, and is always 0.
bool signal_is_left_out(uint16_t place);
/// NULL behind the last one.
const signal_info_t* signal_info(uint16_t place);

#if defined(__cplusplus)
}
#endif

#endif

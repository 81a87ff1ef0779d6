// The table of the signals, and looking at several of one control interrupt. Nothing is copied while nobody looks.

#include "firmware/drive/signals.h"

#include <stddef.h>

#include "firmware/base/edition.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

// By Clarke's components of the windows: they have offset and gains in them already.
static int32_t phase_current(const volatile drive_t* d, bool of_b) {
  const uint16_t count = d->samples.count & ESTIMATOR_WINDOWS;  // three: a mask, too
  int32_t alpha_q17 = 0;
  int32_t beta_q17 = 0;
  for (uint16_t k = 0; k < count; k++) {
    alpha_q17 += q_shr(d->samples.windows[k].current_q20.alpha, 3);
    if (of_b) beta_q17 += q_shr(d->samples.windows[k].current_q20.beta, 3);
  }
  const int32_t share_q30 = position_per_windows_q30[count];
  if (!of_b) return q_mul_sat(alpha_q17, share_q30, 27);
  return q_mul_sat(2 * q_mul_hi(beta_q17, FRAME_SQRT3_HALF_Q31) - q_shr(alpha_q17, 1), share_q30, 27);
}

#include "firmware/drive/signal_looks.h"
// Behind it: its looks.
#include "firmware/dictionary/signal_list.h"
#undef SIGNAL
#undef ASKED
#define ASKED DRIVE

int32_t look_at_nothing(const volatile drive_t* d, uint16_t known) {
  (void)d;
  (void)known;
  return 0;
}

#define SIGNAL(name, unit, q, of, value, meaning) {TEXT_SIGNAL_NAME_##name, q, of, UNIT_##unit},
static const signal_info_t table[] = {
#include "firmware/dictionary/all_signals.h"
};
#undef SIGNAL

#define COUNT ((uint16_t)(sizeof table / sizeof table[0]))

uint16_t signal_count(void) { return COUNT; }

const signal_info_t* signal_info(uint16_t place) { return (place < COUNT) ? &table[place] : NULL; }

uint16_t signal_named(const uint16_t* name, uint16_t count) {
  return packed_find(TEXT_SIGNAL_NAME_state, COUNT, name, count);
}

bool signal_is_left_out(uint16_t place) { return rows_have(edition_signals_left_out, place); }

signal_look_t* signal_look(uint16_t place) { return edition_signal_looks[place]; }

static int32_t look_at(uint16_t place, uint16_t known) {
  return (place < COUNT) ? edition_signal_looks[place](&drive, known) : 0;
}

// The interrupt runs as a whole between two instructions of this level: if it has not counted on, it has not been here.
signals_seen_t drive_signals_copy(const uint16_t* places, uint16_t count, int32_t* copy) {
  const volatile uint16_t* const interrupts = &drive.heartbeat;
  const volatile uint32_t* const clock = &drive.time_ms;
  uint16_t seen;
  signals_seen_t with;
  do {
    seen = *interrupts;
    with.time_ms = *clock;
    with.known = drive_known(&drive);
    for (uint16_t k = 0; k < count; k++) copy[k] = look_at(places[k], with.known);
  } while (seen != *interrupts);
  return with;
}

// The struct is an array with names, in the table's order.
typedef char signals_are_an_array[(sizeof(drive_signals_t) == COUNT * sizeof(int32_t)) ? 1 : -1];

drive_signals_t drive_signals(void) {
  const volatile uint16_t* const interrupts = &drive.heartbeat;
  drive_signals_t s;
  int32_t* const values = (int32_t*)(void*)&s;
  uint16_t seen;
  do {
    seen = *interrupts;
    const uint16_t known = drive_known(&drive);
    for (uint16_t k = 0; k < COUNT; k++) values[k] = edition_signal_looks[k](&drive, known);
  } while (seen != *interrupts);
  return s;
}

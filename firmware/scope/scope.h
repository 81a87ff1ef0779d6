// Captured scope: up to four signals, recorded in the control interrupt around a trigger.
//
// A record is one word per channel: floor(raw / 2^shift) of a signal of signal_list.h, saturated to +-32767, so its
// unit is that of the signal and its format Q(q - shift). SCOPE_DEPTH records are kept, one in every `decimation`
// control interrupts (100 us). `pretrigger` of them lie before the record of the trigger, which is therefore record
// number `pretrigger` of a finished capture.
//
// An edge goes through `level` with a hysteresis, so that noise on a signal that falls is no rise: it rises when it has
// been more than the hysteresis below the level, and then reaches it. SCOPE_BY_SPAN takes a quarter of what the signal
// has spanned of late for it, and twice that for an edge back to where the signal comes from, which on a slow fall is
// noise: there its mean of late is beyond the level by more than the quarter. Extremes and mean are forgotten with a
// time constant of 0.8 s, from the arming on. ABOVE and BELOW need no edge and have no hysteresis.
//
//   IDLE ──arm──> FILLING ──pre-trigger part recorded──> ARMED ──trigger──> TRIGGERED ──rest recorded──> DONE
//
// The trigger signal is looked at in every control interrupt, also between two records, in all its 32 bits; an edge
// goes through `level` from one interrupt to the next (an angle's wrap counts as an edge, too). What happens while
// FILLING does not trigger: no record lacks its pre-trigger part. In AUTO mode a finished capture is kept until
// scope_read has given the last word of every channel; then it arms itself again.
//
// All but scope_step are for the background level. Cost: CYCLES_SCOPE of firmware/interfaces/isr_cycles.h while
// recording. RAM: SCOPE_CHANNELS * SCOPE_DEPTH words.

#ifndef STILLSPIN_FIRMWARE_SCOPE_SCOPE_H
#define STILLSPIN_FIRMWARE_SCOPE_SCOPE_H

#include <stdbool.h>
#include <stdint.h>

#define SCOPE_CHANNELS 4u
#define SCOPE_DEPTH 512u         // records; a power of two
#define SCOPE_SHIFT_MAX 31u      // of a channel
#define SCOPE_BY_SPAN (-1L)      // a hysteresis
#define SCOPE_NOWHERE 0xFFFFu    // no trigger yet
#define SCOPE_UNKNOWN INT16_MIN  // in a record: the signal was unknown (known_t)

typedef enum {
  SCOPE_IDLE = 0,
  SCOPE_FILLING = 1,    // records the pre-trigger part
  SCOPE_ARMED = 2,      // waits for the trigger, recording
  SCOPE_TRIGGERED = 3,  // records the rest
  SCOPE_DONE = 4
} scope_state_t;

typedef enum { SCOPE_SINGLE = 0, SCOPE_AUTO = 1 } scope_mode_t;

typedef enum {
  SCOPE_RISING = 0,   // from below level - hysteresis to level or above
  SCOPE_FALLING = 1,  // from level + hysteresis or above to below level
  SCOPE_EITHER = 2,
  SCOPE_AT_ONCE = 3,
  SCOPE_ABOVE = 4,  // at level or above, whatever it was before
  SCOPE_BELOW = 5
} scope_edge_t;

typedef struct {
  uint16_t signal;  // index in signal_list.h
  uint16_t shift;   // 0..SCOPE_SHIFT_MAX
} scope_channel_t;

typedef struct {
  uint16_t decimation;  // control interrupts per record, 1..65535
  uint16_t pretrigger;  // records, 0..SCOPE_DEPTH - 1
  scope_mode_t mode;
  scope_edge_t edge;
  uint16_t trigger;    // index of the trigger signal
  uint16_t count;      // channels, 1..SCOPE_CHANNELS
  int32_t level;       // raw, in the trigger's format
  int32_t hysteresis;  // the same; SCOPE_BY_SPAN
  scope_channel_t channel[SCOPE_CHANNELS];
} scope_setup_t;

typedef struct {
  scope_state_t state;
  uint16_t recorded;         // records that are kept, 0..SCOPE_DEPTH
  uint16_t trigger_at;       // number of the trigger's record from the oldest; SCOPE_NOWHERE before
  uint32_t trigger_time_ms;  // drive_t.time_ms of the trigger
} scope_status_t;

/// Forgets set-up and records: power-on state.
void scope_reset(void);

/// Takes a set-up over, ends what is running and forgets its records. False, with nothing changed, when a member is out
/// of its range.
bool scope_setup(const scope_setup_t* setup);

/// The set-up in force; count 0 before the first.
const scope_setup_t* scope_setup_in_force(void);

/// Starts a capture, and starts again one that runs or is done. False without a set-up.
bool scope_arm(void);

/// Ends a capture and AUTO; the records so far stay and can be read. A finished one stays DONE.
void scope_stop(void);

scope_status_t scope_status(void);

/// Words `offset` .. of a channel, counted from the oldest record. Returns how many there were, at most `count`; none
/// while a capture runs.
uint16_t scope_read(uint16_t channel, uint16_t offset, int16_t* words, uint16_t count);

/// Control interrupt level, at its end: hangs itself there while a capture runs (drive_onlooker).
void scope_step(void);

#endif

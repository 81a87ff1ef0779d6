#include "firmware/scope/scope.h"

#include <stddef.h>

#include "firmware/drive/signals.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/mode/mode.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "hal/qmath/qmath.h"

#define RING_MASK (SCOPE_DEPTH - 1u)
#define SPAN_FORGETS 13u  // extremes and mean follow the signal with 2^13 control interrupts

// What the set-up names, found once: the interrupt has no time to look it up.
typedef struct {
  signal_look_t* look;
  uint16_t needs, shift;
} watched_t;

// The background level changes set-up and ring only while the interrupt has no onlooker; so that is written first at an
// end and last at a start.
typedef struct {
  volatile scope_state_t state;
  uint16_t head;                  // the next record
  uint16_t recorded;              // 0..SCOPE_DEPTH
  uint16_t wait;                  // control interrupts to the next record
  uint16_t left;                  // records still to come, when TRIGGERED
  uint16_t wanted;                // what an edge of the set-up is met by
  bool was_below, was_above;      // by the hysteresis, since the last edge
  bool fired;                     // since the last record
  uint16_t mark;                  // the trigger's record; SCOPE_NOWHERE
  uint16_t unread;                // AUTO: a bit for each channel whose last word has not been read; none behind a stop
  int32_t lowest, highest, mean;  // of the trigger signal, of late; nothing yet while the lowest is the higher one
  signal_look_t* trigger_look;
  scope_setup_t setup;
  watched_t watched[SCOPE_CHANNELS];
  uint32_t mark_time_ms;
} scope_t;
static scope_t scope;
static int16_t ring[SCOPE_CHANNELS][SCOPE_DEPTH];

// What an edge of the set-up is met by.
#define RISES 1u
#define FALLS 2u
#define IS_ABOVE 4u
#define IS_BELOW 8u

static void find_watched(void) {
  static const uint16_t of_edge[] = {RISES, FALLS, RISES | FALLS, IS_ABOVE | IS_BELOW, IS_ABOVE, IS_BELOW};
  scope.wanted = of_edge[scope.setup.edge];
  scope.trigger_look = signal_look(scope.setup.trigger);
  for (uint16_t k = 0; k < SCOPE_CHANNELS; k++) {
    const scope_channel_t* const c = &scope.setup.channel[k];
    const watched_t w = {signal_look(c->signal), signal_info(c->signal)->needs, c->shift};
    scope.watched[k] = w;
  }
}

static bool is_running(void) {
  const scope_state_t now = scope.state;
  return now >= SCOPE_FILLING && now <= SCOPE_TRIGGERED;
}

// Nothing is recorded from here on: an interrupt in between finds no onlooker any more.
static void rest(scope_state_t now) {
  drive_onlooker = NULL;
  scope.state = now;
}

static void forget_records(void) {
  scope.head = 0;
  scope.recorded = 0;
  scope.mark = SCOPE_NOWHERE;
  scope.mark_time_ms = 0;
}

void scope_reset(void) {
  static const scope_setup_t none = {0};
  rest(SCOPE_IDLE);
  scope.setup = none;
  find_watched();
  forget_records();
}

static bool is_valid(const scope_setup_t* s) {
  if (s->decimation < 1u || s->pretrigger >= SCOPE_DEPTH || s->trigger >= signal_count()) return false;
  if (s->mode > SCOPE_AUTO || s->edge > SCOPE_BELOW) return false;
  if (s->count < 1u || s->count > SCOPE_CHANNELS) return false;
  for (uint16_t k = 0; k < SCOPE_CHANNELS; k++) {
    if (s->channel[k].signal >= signal_count() || s->channel[k].shift > SCOPE_SHIFT_MAX) return false;
  }
  return true;
}

bool scope_setup(const scope_setup_t* setup) {
  if (!is_valid(setup)) return false;
  rest(SCOPE_IDLE);
  scope.setup = *setup;
  find_watched();
  forget_records();
  return true;
}

const scope_setup_t* scope_setup_in_force(void) { return &scope.setup; }

bool scope_arm(void) {
  if (scope.setup.count == 0u) return false;
  rest(SCOPE_IDLE);
  forget_records();
  scope.wait = 1;
  scope.lowest = INT32_MAX;
  scope.highest = INT32_MIN;
  scope.was_below = false;
  scope.was_above = false;
  scope.fired = false;
  scope.unread = (uint16_t)((1u << scope.setup.count) - 1u);
  scope.state = SCOPE_FILLING;
  drive_onlooker = scope_step;
  return true;
}

void scope_stop(void) {
  const uint16_t interrupts = hal_irq_disable();
  if (is_running()) rest(SCOPE_IDLE);
  hal_irq_restore(interrupts);
  scope.unread = 0;
}

static uint16_t oldest(void) { return (uint16_t)((scope.head - scope.recorded) & RING_MASK); }

scope_status_t scope_status(void) {
  const uint16_t interrupts = hal_irq_disable();
  scope_status_t s = {scope.state, scope.recorded, SCOPE_NOWHERE, scope.mark_time_ms};
  if (scope.mark != SCOPE_NOWHERE) s.trigger_at = (uint16_t)((scope.mark - oldest()) & RING_MASK);
  hal_irq_restore(interrupts);
  return s;
}

// The last word of a channel has been read: the next capture, when that was the last channel.
static void note_read_to_the_end(uint16_t channel) {
  if (scope.setup.mode != SCOPE_AUTO || scope.unread == 0u) return;
  scope.unread = (uint16_t)(scope.unread & ~(1u << channel));
  if (scope.unread == 0u) (void)scope_arm();
}

uint16_t scope_read(uint16_t channel, uint16_t offset, int16_t* words, uint16_t count) {
  if (is_running() || channel >= scope.setup.count || offset >= scope.recorded) return 0;
  const uint16_t there = (uint16_t)(scope.recorded - offset);
  const uint16_t given = (count < there) ? count : there;
  uint16_t at = (uint16_t)(oldest() + offset);
  for (uint16_t k = 0; k < given; k++, at++) words[k] = ring[channel][at & RING_MASK];
  if (given == there) note_read_to_the_end(channel);
  return given;
}

// ---- control interrupt level ---------------------------------------------------------------------------------------

// How far `to` is above `from`: of any two numbers, as it needs no sign.
static uint32_t above_by(int32_t from, int32_t to) { return (uint32_t)to - (uint32_t)from; }

// Of a distance of at least one the share that is followed: at least one, so that what has few steps is forgotten, too,
// and never more than the distance, so that what follows does not overflow.
static uint32_t share_of(uint32_t distance) { return (distance >> SPAN_FORGETS) + 1u; }

static int32_t follow_up(int32_t from, int32_t to) { return (int32_t)((uint32_t)from + share_of(above_by(from, to))); }

static int32_t follow_down(int32_t from, int32_t to) {
  return (int32_t)((uint32_t)from - share_of(above_by(to, from)));
}

static void follow_span(int32_t value) {
  if (scope.lowest > scope.highest) scope.mean = value;
  scope.lowest = (value > scope.lowest) ? follow_up(scope.lowest, value) : value;
  scope.highest = (value < scope.highest) ? follow_down(scope.highest, value) : value;
  if (value > scope.mean) {
    scope.mean = follow_up(scope.mean, value);
  } else if (value < scope.mean) {
    scope.mean = follow_down(scope.mean, value);
  }
}

// An edge against the way that the signal has gone of late has to be twice as large: noise is not. `against_by`: how
// far the mean is on the other side of the level, 0 when it is on this one.
static bool is_beyond(uint32_t by, uint32_t against_by) {
  const int32_t given = scope.setup.hysteresis;
  if (given >= 0) return by >= (uint32_t)given;
  const uint32_t quarter = above_by(scope.lowest, scope.highest) >> 2;
  return by >= ((against_by > quarter) ? quarter + quarter : quarter);
}

// By the hysteresis below the level is what is lower than it by more than that.
static bool is_met(int32_t value) {
  const int32_t level = scope.setup.level;
  uint16_t is;
  if (value >= level) {
    is = scope.was_below ? IS_ABOVE | RISES : IS_ABOVE;
    scope.was_below = false;
    if (!scope.was_above) {
      scope.was_above = is_beyond(above_by(level, value), (scope.mean < level) ? above_by(scope.mean, level) : 0u);
    }
  } else {
    is = scope.was_above ? IS_BELOW | FALLS : IS_BELOW;
    scope.was_above = false;
    if (!scope.was_below) {
      scope.was_below = is_beyond(above_by(value, level) - 1u, (scope.mean > level) ? above_by(level, scope.mean) : 0u);
    }
  }
  return (is & scope.wanted) != 0u;
}

static void watch_trigger(int32_t value) {
  if (scope.setup.hysteresis < 0) follow_span(value);
  const bool met = is_met(value);
  scope_state_t now = scope.state;
  if (now == SCOPE_FILLING && scope.recorded >= scope.setup.pretrigger) {
    now = SCOPE_ARMED;
    scope.state = now;
  }
  if (met && now == SCOPE_ARMED) scope.fired = true;
}

// The trigger's signal is looked at once, where it is recorded as well.
static void record(uint16_t here, uint16_t known, int32_t trigger) {
  const uint16_t unknown = (uint16_t)~known;
  const watched_t* const end = scope.watched + scope.setup.count;
  int16_t (*row)[SCOPE_DEPTH] = ring;
  for (const watched_t* w = scope.watched; w < end; w++, row++) {
    int16_t word = SCOPE_UNKNOWN;
    if ((w->needs & unknown) == 0u) {
      const int32_t value = (w->look == scope.trigger_look) ? trigger : w->look(&drive, known);
      word = (int16_t)q_clamp(q_shr(value, w->shift), -INT16_MAX, INT16_MAX);
    }
    (*row)[here] = word;
  }
  scope.head = (uint16_t)((here + 1u) & RING_MASK);
  if (scope.recorded < SCOPE_DEPTH) scope.recorded++;
}

// The drive's onlooker while the scope runs, and only then.
void scope_step(void) {
  hal_profile_step(CYCLES_SCOPE);
  const uint16_t known = drive_known(&drive);
  const int32_t trigger = scope.trigger_look(&drive, known);
  watch_trigger(trigger);
  if (--scope.wait > 0u) return;
  scope.wait = scope.setup.decimation;
  const uint16_t here = scope.head;
  record(here, known, trigger);
  scope_state_t now = scope.state;
  if (now == SCOPE_ARMED && scope.fired) {
    scope.mark = here;
    scope.mark_time_ms = drive.time_ms;
    scope.left = (uint16_t)(SCOPE_DEPTH - scope.setup.pretrigger);
    now = SCOPE_TRIGGERED;
    scope.state = now;
  }
  if (now == SCOPE_TRIGGERED && --scope.left == 0u) rest(SCOPE_DONE);
}

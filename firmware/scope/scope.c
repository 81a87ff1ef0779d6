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

// The background level changes set-up and ring only while `state` is IDLE or DONE, when the interrupt leaves them
// alone; so the state is written first at an end and last at a start.
static volatile scope_state_t state;
static scope_setup_t setup_in_force;
static int16_t ring[SCOPE_CHANNELS][SCOPE_DEPTH];
static uint16_t head;      // the next record
static uint16_t recorded;  // 0..SCOPE_DEPTH
static uint16_t wait;      // control interrupts to the next record
static uint16_t left;      // records still to come, when TRIGGERED
static uint16_t mark;      // the trigger's record; SCOPE_NOWHERE
static uint32_t mark_time_ms;
static int32_t lowest, highest, mean;  // of the trigger signal, of late
static bool was_below, was_above;      // by the hysteresis, since the last edge
static bool fresh;                     // there is no value yet
static bool fired;                     // since the last record
static uint16_t unread;  // AUTO: a bit for each channel whose last word has not been read; none behind a stop

static bool is_running(void) {
  const scope_state_t now = state;
  return now >= SCOPE_FILLING && now <= SCOPE_TRIGGERED;
}

// Nothing is recorded from here on.
static void rest(scope_state_t now) {
  state = now;
  drive_onlooker = NULL;
}

static void forget_records(void) {
  head = 0;
  recorded = 0;
  mark = SCOPE_NOWHERE;
  mark_time_ms = 0;
}

void scope_reset(void) {
  static const scope_setup_t none = {0};
  rest(SCOPE_IDLE);
  setup_in_force = none;
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
  setup_in_force = *setup;
  forget_records();
  return true;
}

const scope_setup_t* scope_setup_in_force(void) { return &setup_in_force; }

bool scope_arm(void) {
  if (setup_in_force.count == 0u) return false;
  rest(SCOPE_IDLE);
  forget_records();
  wait = 1;
  fresh = true;
  was_below = false;
  was_above = false;
  fired = false;
  unread = (uint16_t)((1u << setup_in_force.count) - 1u);
  state = SCOPE_FILLING;
  drive_onlooker = scope_step;
  return true;
}

void scope_stop(void) {
  const uint16_t interrupts = hal_irq_disable();
  if (is_running()) rest(SCOPE_IDLE);
  hal_irq_restore(interrupts);
  unread = 0;
}

static uint16_t oldest(void) { return (uint16_t)((head - recorded) & RING_MASK); }

scope_status_t scope_status(void) {
  const uint16_t interrupts = hal_irq_disable();
  scope_status_t s = {state, recorded, SCOPE_NOWHERE, mark_time_ms};
  if (mark != SCOPE_NOWHERE) s.trigger_at = (uint16_t)((mark - oldest()) & RING_MASK);
  hal_irq_restore(interrupts);
  return s;
}

// The last word of a channel has been read: the next capture, when that was the last channel.
static void note_read_to_the_end(uint16_t channel) {
  if (setup_in_force.mode != SCOPE_AUTO || unread == 0u) return;
  unread = (uint16_t)(unread & ~(1u << channel));
  if (unread == 0u) (void)scope_arm();
}

uint16_t scope_read(uint16_t channel, uint16_t offset, int16_t* words, uint16_t count) {
  if (is_running() || channel >= setup_in_force.count || offset >= recorded) return 0;
  const uint16_t there = (uint16_t)(recorded - offset);
  const uint16_t given = (count < there) ? count : there;
  uint16_t at = (uint16_t)(oldest() + offset);
  for (uint16_t k = 0; k < given; k++, at++) words[k] = ring[channel][at & RING_MASK];
  if (given == there) note_read_to_the_end(channel);
  return given;
}

// ---- control interrupt level ---------------------------------------------------------------------------------------

// At least by one, so that what has few steps is forgotten, too.
static int32_t follow(int32_t from, int32_t to) {
  const int32_t off = q_sub_sat(to, from);
  return q_add_sat(from, q_shr(off, SPAN_FORGETS) + (off > 0 ? 1 : 0));
}

static int32_t quarter_of_span(int32_t value) {
  if (fresh) lowest = highest = mean = value;
  lowest = q_min(value, follow(lowest, value));
  highest = q_max(value, follow(highest, value));
  mean = follow(mean, value);
  return q_shr(q_sub_sat(highest, lowest), 2);
}

// An edge against the way that the signal has gone of late has to be twice as large: noise is not.
static void look_beyond(int32_t value, bool above) {
  const int32_t level = setup_in_force.level;
  int32_t below_by = setup_in_force.hysteresis, above_by = below_by;
  if (below_by < 0) {
    const int32_t quarter = quarter_of_span(value);
    const int32_t off = q_sub_sat(mean, level);
    below_by = (off > quarter) ? quarter + quarter : quarter;
    above_by = (off < -quarter) ? quarter + quarter : quarter;
  }
  was_below = !above && (was_below || value < q_sub_sat(level, below_by));
  was_above = above && (was_above || value >= q_add_sat(level, above_by));
}

static bool is_met(int32_t value) {
  const bool above = value >= setup_in_force.level;
  const bool rises = above && was_below;
  const bool falls = !above && was_above;
  look_beyond(value, above);
  switch (setup_in_force.edge) {
    case SCOPE_RISING:
      return rises;
    case SCOPE_FALLING:
      return falls;
    case SCOPE_EITHER:
      return rises || falls;
    case SCOPE_ABOVE:
      return above;
    case SCOPE_BELOW:
      return !above;
    default:
      return true;
  }
}

static void watch_trigger(uint16_t known) {
  const bool met = is_met(drive_signal(setup_in_force.trigger, known));
  if (state == SCOPE_FILLING && recorded >= setup_in_force.pretrigger) state = SCOPE_ARMED;
  if (state == SCOPE_ARMED && met) fired = true;
  fresh = false;
}

static void record(uint16_t known) {
  for (uint16_t k = 0; k < setup_in_force.count; k++) {
    const scope_channel_t* const c = &setup_in_force.channel[k];
    const int32_t value = q_clamp(q_shr(drive_signal(c->signal, known), c->shift), -INT16_MAX, INT16_MAX);
    ring[k][head] = drive_signal_is_known(c->signal, known) ? (int16_t)value : SCOPE_UNKNOWN;
  }
  head = (uint16_t)((head + 1u) & RING_MASK);
  if (recorded < SCOPE_DEPTH) recorded++;
}

void scope_step(void) {
  if (!is_running()) return;
  hal_profile_step(CYCLES_SCOPE);
  const uint16_t known = drive_known(&drive);
  watch_trigger(known);
  if (--wait > 0u) return;
  wait = setup_in_force.decimation;
  const uint16_t here = head;
  record(known);
  if (state == SCOPE_ARMED && fired) {
    mark = here;
    mark_time_ms = drive.time_ms;
    left = (uint16_t)(SCOPE_DEPTH - setup_in_force.pretrigger);
    state = SCOPE_TRIGGERED;
  }
  if (state == SCOPE_TRIGGERED && --left == 0u) rest(SCOPE_DONE);
}

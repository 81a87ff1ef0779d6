#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

#define MOVED_Q20 131072L  // 0.125 A: so far from its operating point the model may be
#define WAITED_MAX 3u      // slots in a row that give way

static const task_t tasks[DRIVE_PERIODS_PER_MS] = {TASK_SPEED, TASK_JUDGE_FIRST, TASK_SLOT, TASK_RENEW, TASK_SLOT,
                                                   TASK_FIELD, TASK_JUDGE,       TASK_SLOT, TASK_RENEW, TASK_SLOT};

// Whether the deviation observer runs at all while the shaft turns.
static bool has_observer(const drive_t* d) {
  if (drive_source_has(d, SOURCE_HANDS_OVER)) return !position_observer_rests(d);
  return drive_source_has(d, SOURCE_OBSERVES);
}

// Observer and flux both at work: the observer leaves the windows out beside speed control and field weakening.
static bool is_beside_flux(const drive_t* d) {
  return drive_source_has(d, SOURCE_HANDS_OVER) && !blend_is_low(&d->estimate.blend);
}

// What cannot wait: operating point or covariance, by turns where both want it, the covariance first where it would be
// renewed anyway. A shaft that is held wants its operating point always.
static bool take_urgent(const drive_t* d, schedule_t* s, bool observes) {
  const bool due = s->update_urgent || (observes && !s->held && deviation_observer_is_due(&d->estimate.observer));
  const bool moved = s->held || q_abs_sat(d->estimate.measured_q20.q - d->estimate.model.iq_q20) > MOVED_Q20;
  if (!moved && !due) return false;
  s->moves = moved && !(due && (s->moved_last || s->update_urgent));
  s->renews = !s->moves;
  s->moved_last = s->moves;
  return true;
}

// In the first millisecond of a run how much the windows will tell is not known yet.
static bool is_young(const drive_t* d) { return d->periods < DRIVE_PERIODS_PER_MS; }

// The first look of an observer is a long one.
static bool is_new(const drive_t* d) { return !d->estimate.observer.is_sensitive; }

static void take_slot(schedule_t* s) {
  s->waited = 0;
  s->last = (uint16_t)((s->last + 1u) % SCHEDULE_SLOTS);
  s->slot = (schedule_slot_t)s->last;
}

static void slot_or_give_way(const drive_t* d, schedule_t* s, bool observes) {
  if ((s->held || s->waited < WAITED_MAX) && take_urgent(d, s, observes)) {
    s->waited++;
  } else {
    take_slot(s);
  }
}

static bool is_judgement(task_t task) { return task == TASK_JUDGE_FIRST || task == TASK_JUDGE; }

// Before the shaft turns nothing is judged or renewed; the synchronism of one that is held is judged once in a
// millisecond.
static bool is_slot(const schedule_t* s) {
  if (!s->turning) return s->task > TASK_FIELD;
  return s->task == TASK_SLOT || (s->held && s->task == TASK_JUDGE_FIRST);
}

// Whether the observer finds time for the windows, which may make it renew the covariance as well.
static bool has_room(const drive_t* d) {
  const schedule_t* const s = &d->schedule;
  const bool is_long = s->task == TASK_SPEED || s->task == TASK_FIELD;
  if (is_long && is_beside_flux(d)) return false;
  const bool of_model = s->slot == SLOT_OPERATING_POINT || s->slot == SLOT_LOOK;
  return !s->update_urgent || s->renews || !(is_long || s->judges || is_young(d) || (of_model && is_new(d)));
}

// A shaft that is caught wants its field weakened before it counts as one that turns.
static bool is_beside_field(const drive_t* d) { return d->flags.caught && d->schedule.task == TASK_FIELD; }

static void begin(schedule_t* s) {
  s->period = (s->period < DRIVE_PERIODS_PER_MS - 1u) ? (uint16_t)(s->period + 1u) : 0u;
  s->task = tasks[s->period];
  s->slot = SCHEDULE_SLOTS;
  s->moves = false;
  s->renews = false;
  s->judges = false;
  s->exclusive = false;
  s->skips = false;
}

void schedule_next(const drive_t* d, schedule_t* s) {
  begin(s);
  s->turning = drive_is_turning(d) || d->flags.open_loop;
  const bool observes = s->turning && has_observer(d);
  s->held = hold_is_on(d);
  s->unsure = observes && !deviation_observer_is_sure(&d->estimate.observer);
  s->update_urgent = observes && (is_young(d) || deviation_observer_update_is_urgent(&d->estimate.observer));
  if (is_slot(s)) {
    s->exclusive = d->flags.wants_exclusive;
    if (!s->exclusive) slot_or_give_way(d, s, observes);
  } else {
    s->renews = s->task == TASK_RENEW;
    s->judges = is_judgement(s->task) && !s->unsure && !is_young(d) && d->state != DRIVE_START;
  }
  s->skips = s->exclusive || (observes && !has_room(d)) || is_beside_field(d);
}

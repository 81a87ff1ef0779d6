#include "svpwm/extended.h"

#define SEARCH_STEPS 6

typedef struct {
  uint16_t hi, mid, lo;
} order_t;

typedef struct {
  int16_t first, second;  // A, B
  int16_t low_on;         // m
  int16_t length;         // m + A + B
} layout_t;

static order_t sort_legs(const int16_t leg[SVPWM_LEGS]) {
  order_t o = {0, 1, 2};
  uint16_t swap;
  if (leg[o.hi] < leg[o.mid]) {
    swap = o.hi;
    o.hi = o.mid;
    o.mid = swap;
  }
  if (leg[o.mid] < leg[o.lo]) {
    swap = o.mid;
    o.mid = o.lo;
    o.lo = swap;
  }
  if (leg[o.hi] < leg[o.mid]) {
    swap = o.hi;
    o.hi = o.mid;
    o.mid = swap;
  }
  return o;
}

static layout_t layout_for(int16_t t1, int16_t t2, int16_t window) {
  layout_t l;
  l.first = q_max16(t1, window);
  l.second = q_max16(t2, window);
  // hi and mid must still be on when lo rises, or the second vector would be cut short.
  const int16_t keep_hi = (int16_t)(l.first + l.second - t1 - t2);
  const int16_t keep_mid = (int16_t)(l.second - t2);
  l.low_on = q_max16(SVPWM_PULSE_MIN_TICKS, q_max16(keep_hi, keep_mid));
  l.length = (int16_t)(l.low_on + l.first + l.second);
  return l;
}

// The longest window between the limits whose layout fits into `room`; 0 when not even the shortest does.
static int16_t longest_window(int16_t t1, int16_t t2, int16_t room, const extended_config_t* c) {
  int16_t good = c->window_min_ticks;
  int16_t bad = (int16_t)(c->window_max_ticks + 1);
  if (layout_for(t1, t2, c->window_max_ticks).length <= room) return c->window_max_ticks;
  if (layout_for(t1, t2, good).length > room) return 0;
  for (int16_t n = 0; n < SEARCH_STEPS; n++) {
    const int16_t trial = (int16_t)((good + bad) / 2);
    if (layout_for(t1, t2, trial).length <= room)
      good = trial;
    else
      bad = trial;
  }
  return good;
}

void svpwm_extended(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses) {
  const order_t o = sort_legs(t->leg);
  const int16_t t1 = (int16_t)(t->leg[o.hi] - t->leg[o.mid]);
  const int16_t t2 = (int16_t)(t->leg[o.mid] - t->leg[o.lo]);
  int16_t window = longest_window(t1, t2, (int16_t)(SVPWM_ROOM_TICKS - c->zero_ticks), c);
  if (window == 0) window = longest_window(t1, t2, SVPWM_ROOM_TICKS, c);
  const layout_t l = layout_for(t1, t2, window);
  pulses->rise[o.hi] = SVPWM_FIRST_TICK;
  pulses->rise[o.mid] = (int16_t)(SVPWM_FIRST_TICK + l.first);
  pulses->rise[o.lo] = (int16_t)(SVPWM_FIRST_TICK + l.first + l.second);
  pulses->fall[o.hi] = (int16_t)(pulses->rise[o.hi] + t1 + t2 + l.low_on);
  pulses->fall[o.mid] = (int16_t)(pulses->rise[o.mid] + t2 + l.low_on);
  pulses->fall[o.lo] = (int16_t)(pulses->rise[o.lo] + l.low_on);
}

void svpwm_centred(const svpwm_on_time_t* t, svpwm_pulses_t* pulses) {
  const order_t o = sort_legs(t->leg);
  const int16_t middle = (SVPWM_FIRST_TICK + SVPWM_LAST_TICK) / 2;
  // The common part puts the largest and the smallest on-time at equal distance from half the room, as far as the
  // shortest pulse allows.
  const int16_t even = (int16_t)(SVPWM_ROOM_TICKS / 2 - (t->leg[o.hi] + t->leg[o.lo]) / 2);
  const int16_t common = q_max16(even, (int16_t)(SVPWM_PULSE_MIN_TICKS - t->leg[o.lo]));
  for (uint16_t k = 0; k < SVPWM_LEGS; k++) {
    const int16_t on = (int16_t)(common + t->leg[k]);
    pulses->rise[k] = (int16_t)(middle - on / 2);
    pulses->fall[k] = (int16_t)(pulses->rise[k] + on);
  }
}

void svpwm_long_zero(const svpwm_on_time_t* t, svpwm_pulses_t* pulses) {
  const order_t o = sort_legs(t->leg);
  for (uint16_t k = 0; k < SVPWM_LEGS; k++) {
    pulses->rise[k] = SVPWM_FIRST_TICK;
    pulses->fall[k] = (int16_t)(SVPWM_FIRST_TICK + SVPWM_PULSE_MIN_TICKS + t->leg[k] - t->leg[o.lo]);
  }
}

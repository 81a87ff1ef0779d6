#include "svpwm/extended.h"

typedef struct {
  int32_t first, second;  // A, B
  int32_t low_on;         // m
} layout_t;

static layout_t layout_for(int32_t t1, int32_t t2, int32_t window1, int32_t window2) {
  layout_t l;
  l.first = q_max(t1, window1);
  l.second = q_max(t2, window2);
  // hi and mid must still be on when lo rises, or the second vector would be cut short.
  const int32_t keep_mid = l.second - t2;
  const int32_t keep_hi = l.first - t1 + keep_mid;
  l.low_on = q_max(SVPWM_PULSE_MIN_TICKS, q_max(keep_hi, keep_mid));
  return l;
}

// With S = first + second, low_on is the larger of the shortest pulse and S - t1 - t2, so the layout fits as long as S
// is at most room - shortest pulse and (room + t1 + t2) / 2.
static int32_t most_of_both(int32_t t1, int32_t t2, int32_t room) {
  return q_min(room - SVPWM_PULSE_MIN_TICKS, (room + t1 + t2) / 2);
}

// The longest window between the limits whose layout fits into `room`; 0 when not even the shortest does.
//
// S is t1 + t2 up to a window of the shorter of the two, then the longer one and a window, and two windows beyond the
// longer one.
static int32_t longest_window(int32_t t1, int32_t t2, int32_t room, const extended_config_t* c) {
  const int32_t most = most_of_both(t1, t2, room);
  const int32_t longer = q_max(t1, t2);
  const int32_t window = (most >= 2 * longer) ? most / 2 : most - longer;
  if (most < t1 + t2 || window < c->window_min_ticks) return 0;
  return q_min(window, c->window_max_ticks);
}

static void lay_out(const svpwm_on_time_t* t, int32_t t1, int32_t t2, const layout_t* l, svpwm_pulses_t* pulses) {
  const int32_t hi = SVPWM_FIRST_TICK;
  const int32_t mid = hi + l->first;
  const int32_t lo = mid + l->second;
  svpwm_put_pulse(pulses, t->hi, hi, t1 + t2 + l->low_on);
  svpwm_put_pulse(pulses, t->mid, mid, t2 + l->low_on);
  svpwm_put_pulse(pulses, t->lo, lo, l->low_on);
  svpwm_put_order(pulses, t->hi, t->mid, t->lo, svpwm_fall_of(t->hi), svpwm_fall_of(t->mid), svpwm_fall_of(t->lo));
}

void svpwm_extended(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses) {
  const int32_t t1 = t->leg[t->hi] - t->leg[t->mid];
  const int32_t t2 = t->leg[t->mid] - t->leg[t->lo];
  int32_t window = longest_window(t1, t2, SVPWM_ROOM_TICKS - c->zero_ticks, c);
  if (window == 0) window = longest_window(t1, t2, SVPWM_ROOM_TICKS, c);
  const layout_t l = layout_for(t1, t2, window, window);
  lay_out(t, t1, t2, &l, pulses);
}

// What the zero vector 000 has behind the last edge when nothing is extended.
static int32_t own_zero(int32_t t1, int32_t t2) {
  return SVPWM_PERIOD_TICKS - SVPWM_FIRST_TICK - SVPWM_PULSE_MIN_TICKS - t1 - t2;
}

void svpwm_cheapest_pair(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses) {
  const int32_t t1 = t->leg[t->hi] - t->leg[t->mid];
  const int32_t t2 = t->leg[t->mid] - t->leg[t->lo];
  const bool first = t1 >= t2;
  if (own_zero(t1, t2) < c->window_min_ticks) {
    svpwm_extended(c, t, pulses);
    return;
  }
  // As long as the zero vector stays as long as the window, and at most window_maximum.
  const int32_t room = SVPWM_ROOM_TICKS - q_min(own_zero(t1, t2), c->window_max_ticks);
  const int32_t other = first ? t2 : t1;
  const int32_t window = q_min(most_of_both(t1, t2, room) - other, c->window_max_ticks);
  const layout_t l = layout_for(t1, t2, first ? window : 0, first ? 0 : window);
  lay_out(t, t1, t2, &l, pulses);
}

// All legs begin, then they end, the one that is on longest first and last.
static void put_nested_order(svpwm_pulses_t* pulses, const svpwm_on_time_t* t) {
  svpwm_put_order(pulses, t->hi, t->mid, t->lo, svpwm_fall_of(t->lo), svpwm_fall_of(t->mid), svpwm_fall_of(t->hi));
}

static void put_centred(svpwm_pulses_t* pulses, uint16_t leg, int32_t on) {
  svpwm_put_pulse(pulses, leg, (SVPWM_FIRST_TICK + SVPWM_LAST_TICK) / 2 - on / 2, on);
}

void svpwm_centred(const svpwm_on_time_t* t, svpwm_pulses_t* pulses) {
  // The common part puts the largest and the smallest on-time at equal distance from half the room, as far as the
  // shortest pulse allows.
  const int32_t even = SVPWM_ROOM_TICKS / 2 - (t->leg[t->hi] + t->leg[t->lo]) / 2;
  const int32_t common = q_max(even, SVPWM_PULSE_MIN_TICKS - t->leg[t->lo]);
  put_centred(pulses, 0u, common + t->leg[0]);
  put_centred(pulses, 1u, common + t->leg[1]);
  put_centred(pulses, 2u, common + t->leg[2]);
  put_nested_order(pulses, t);
}

void svpwm_long_zero(const svpwm_on_time_t* t, svpwm_pulses_t* pulses) {
  const int32_t common = SVPWM_PULSE_MIN_TICKS - t->leg[t->lo];
  svpwm_put_pulse(pulses, 0u, SVPWM_FIRST_TICK, common + t->leg[0]);
  svpwm_put_pulse(pulses, 1u, SVPWM_FIRST_TICK, common + t->leg[1]);
  svpwm_put_pulse(pulses, 2u, SVPWM_FIRST_TICK, common + t->leg[2]);
  put_nested_order(pulses, t);
}

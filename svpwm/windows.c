#include "svpwm/windows.h"

static int16_t span(const sampling_config_t* c, const svpwm_window_t* w) {
  return (int16_t)(svpwm_burst_end(c, w) - svpwm_burst_start(c, w));
}

// Takes a window after the others, in the place of the shortest if there are too many.
static uint16_t take(const sampling_config_t* c, svpwm_window_t w[], uint16_t count, const svpwm_window_t* fresh) {
  uint16_t shortest = 0;
  if (count < SVPWM_WINDOWS) {
    w[count] = *fresh;
    return (uint16_t)(count + 1u);
  }
  for (uint16_t k = 1; k < SVPWM_WINDOWS; k++) {
    if (span(c, &w[k]) < span(c, &w[shortest])) shortest = k;
  }
  if (span(c, fresh) < span(c, &w[shortest])) return count;
  for (uint16_t k = shortest; k + 1u < SVPWM_WINDOWS; k++) w[k] = w[k + 1u];
  w[SVPWM_WINDOWS - 1] = *fresh;
  return count;
}

// An edge that may come before the one that has ended the last window.
static uint16_t shorten(const sampling_config_t* c, svpwm_window_t w[], uint16_t count, int16_t end) {
  if (count == 0u) return 0;
  svpwm_window_t* const last = &w[count - 1u];
  last->end = q_min16(last->end, end);
  return (span(c, last) >= c->span_min_ticks) ? count : (uint16_t)(count - 1u);
}

// The period's end cuts some.
static uint16_t look_at(const sampling_config_t* c, svpwm_window_t w[], uint16_t count, int32_t begin, int32_t end,
                        uint32_t state) {
  const svpwm_window_t fresh = {(int16_t)begin, (int16_t)end, (uint16_t)state};
  return (span(c, &fresh) >= c->span_min_ticks) ? take(c, w, count, &fresh) : count;
}

void svpwm_find_windows(const sampling_config_t* c, const svpwm_arrival_t* arrival, svpwm_pattern_t* pattern) {
  static const uint16_t leg_bit[SVPWM_EDGES] = {1, 2, 4, 1, 2, 4};
  const int32_t shortest = c->settle_ticks + c->burst_ticks + c->span_min_ticks;
  uint32_t order = pattern->pulses.order;
  uint32_t state = 0;
  int32_t begin = 0;
  int32_t ended = 0;
  uint16_t count = 0;
  while (order != 0u) {  // the last edge is a falling one: none of these is 0
    const uint32_t edge = svpwm_next_edge(&order);
    const int32_t end = arrival->earliest[edge];
    if (end < ended) count = shorten(c, pattern->windows, count, (int16_t)end);
    if (end - begin >= shortest) {  // most intervals are short
      count = look_at(c, pattern->windows, count, begin, end, state);
      ended = end;
    }
    begin = q_max(begin, arrival->latest[edge]);
    state ^= leg_bit[edge];
  }
  if (SVPWM_PERIOD_TICKS - begin >= shortest) {
    count = look_at(c, pattern->windows, count, begin, SVPWM_PERIOD_TICKS, 0);
  }
  pattern->window_count = count;
}

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

// Most intervals are short; the period's end cuts some of the others.
static uint16_t look_at(const sampling_config_t* c, svpwm_window_t w[], uint16_t count, const svpwm_window_t* fresh) {
  return (span(c, fresh) >= c->span_min_ticks) ? take(c, w, count, fresh) : count;
}

// An edge that may come before the one that has ended the last window.
static uint16_t shorten(const sampling_config_t* c, svpwm_window_t w[], uint16_t count, int16_t end) {
  if (count == 0u) return 0;
  svpwm_window_t* const last = &w[count - 1u];
  last->end = q_min16(last->end, end);
  return (span(c, last) >= c->span_min_ticks) ? count : (uint16_t)(count - 1u);
}

void svpwm_find_windows(const sampling_config_t* c, const svpwm_arrival_t* arrival, svpwm_pattern_t* pattern) {
  static const uint16_t leg_bit[SVPWM_EDGES] = {1, 2, 4, 1, 2, 4};
  const int32_t shortest = c->settle_ticks + c->burst_ticks + c->span_min_ticks;
  uint32_t order = pattern->pulses.order;
  svpwm_window_t w = {0, 0, 0};
  int16_t ended = 0;
  uint16_t count = 0;
  for (uint16_t k = 0; k < SVPWM_EDGES; k++) {
    const uint32_t edge = svpwm_next_edge(&order);
    w.end = arrival->earliest[edge];
    if (w.end < ended) count = shorten(c, pattern->windows, count, w.end);
    if (w.end - w.begin >= shortest) {
      count = look_at(c, pattern->windows, count, &w);
      ended = w.end;
    }
    w.begin = q_max16(w.begin, arrival->latest[edge]);
    w.state ^= leg_bit[edge];
  }
  w.end = SVPWM_PERIOD_TICKS;
  if (w.end - w.begin >= shortest) count = look_at(c, pattern->windows, count, &w);
  pattern->window_count = count;
}

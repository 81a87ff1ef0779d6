#include "svpwm/windows.h"

static int32_t span(const sampling_config_t* c, const svpwm_window_t* w) {
  return svpwm_burst_end(c, w) - svpwm_burst_start(c, w);
}

// The shortest goes, where there are too many, and the later ones move up.
static void make_room(const sampling_config_t* c, svpwm_pattern_t* pattern, const svpwm_window_t* interval) {
  svpwm_window_t* const w = pattern->windows;
  uint16_t shortest = 0;
  for (uint16_t k = 1; k < SVPWM_WINDOWS; k++) {
    if (span(c, &w[k]) < span(c, &w[shortest])) shortest = k;
  }
  if (span(c, interval) < span(c, &w[shortest])) return;
  for (uint16_t k = shortest; k + 1u < SVPWM_WINDOWS; k++) w[k] = w[k + 1u];
  w[SVPWM_WINDOWS - 1] = *interval;
}

void svpwm_take_window(const sampling_config_t* c, svpwm_pattern_t* pattern, const svpwm_window_t* interval) {
  if (span(c, interval) < c->span_min_ticks) return;
  if (pattern->window_count < SVPWM_WINDOWS) {
    pattern->windows[pattern->window_count++] = *interval;
  } else {
    make_room(c, pattern, interval);
  }
}

void svpwm_shorten_window(const sampling_config_t* c, svpwm_pattern_t* pattern, int32_t end) {
  if (pattern->window_count == 0u) return;
  svpwm_window_t* const last = &pattern->windows[pattern->window_count - 1u];
  if (end < last->end) last->end = (int16_t)end;
  if (span(c, last) < c->span_min_ticks) pattern->window_count--;
}

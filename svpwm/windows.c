#include "svpwm/windows.h"

static int32_t span(const svpwm_window_t* w) { return (int32_t)w->end - w->start; }

// The shortest goes, where there are too many, and the later ones move up.
void svpwm_replace_window(svpwm_pattern_t* pattern, const svpwm_window_t* window) {
  svpwm_window_t* const w = pattern->windows;
  uint16_t shortest = 0;
  for (uint16_t k = 1; k < SVPWM_WINDOWS; k++) {
    if (span(&w[k]) < span(&w[shortest])) shortest = k;
  }
  if (span(window) < span(&w[shortest])) return;
  for (uint16_t k = shortest; k + 1u < SVPWM_WINDOWS; k++) w[k] = w[k + 1u];
  w[SVPWM_WINDOWS - 1] = *window;
}

void svpwm_take_window(const sampling_config_t* c, svpwm_pattern_t* pattern, int32_t begin, int32_t end,
                       unsigned passed) {
  const svpwm_window_t window = svpwm_window_between(c, begin, end, (passed ^ (passed >> SVPWM_LEGS)) & 7u);
  if (window.end < window.start + c->span_min_ticks) return;
  if (pattern->window_count < SVPWM_WINDOWS) {
    pattern->windows[pattern->window_count++] = window;
  } else {
    const svpwm_window_t more = window;  // in memory where it has to be, and only there
    svpwm_replace_window(pattern, &more);
  }
}

void svpwm_shorten_window(const sampling_config_t* c, svpwm_pattern_t* pattern, int32_t end) {
  if (pattern->window_count == 0u) return;
  svpwm_window_t* const last = &pattern->windows[pattern->window_count - 1u];
  const int32_t last_burst = q_min(end - c->burst_ticks, last->end);
  if (last_burst < last->start + c->span_min_ticks) {
    pattern->window_count--;
    return;
  }
  last->end = (int16_t)last_burst;
}

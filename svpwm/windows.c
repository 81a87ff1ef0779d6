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
  if (fresh->end - fresh->begin < c->settle_ticks + c->burst_ticks + c->span_min_ticks) return count;
  return (span(c, fresh) >= c->span_min_ticks) ? take(c, w, count, fresh) : count;
}

void svpwm_find_windows(const sampling_config_t* c, svpwm_pattern_t* pattern) {
  const svpwm_pulses_t* const p = &pattern->pulses;
  svpwm_walk_t walk = {p->order, 0};
  svpwm_window_t w = {0, 0, 0};
  uint16_t count = 0;
  for (uint16_t k = 0; k < SVPWM_EDGES; k++) {
    bool rises;
    w.state = (uint16_t)walk.state;
    const uint16_t leg = svpwm_next_edge(&walk, &rises);
    w.end = rises ? p->rise[leg] : p->fall[leg];
    count = look_at(c, pattern->windows, count, &w);
    w.begin = w.end;
  }
  w.state = 0;
  w.end = SVPWM_PERIOD_TICKS;
  pattern->window_count = look_at(c, pattern->windows, count, &w);
}

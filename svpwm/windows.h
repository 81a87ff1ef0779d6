// Finds the intervals of constant switching state in a set of pulses and picks those that are worth sampling.

#ifndef STILLSPIN_SVPWM_WINDOWS_H
#define STILLSPIN_SVPWM_WINDOWS_H

#include "svpwm/pattern.h"

#define SAMPLING_SETTLE_MIN_TICKS 400  // to read the window before

typedef struct {
  int16_t settle_ticks;    // from an edge at the motor to the first sample, the above to 2500: ringing
  int16_t burst_ticks;     // length of a burst of conversions
  int16_t span_min_ticks;  // shortest useful time between the two bursts
  int16_t last_tick;       // the last burst must have been triggered by here, so that it is read before the period ends
  uint16_t windows;        // how many of a period are kept: 2 or 3, SVPWM_WINDOWS
} sampling_config_t;

/// The window of an interval: of its edges the first comes at begin at the latest, the last at end at the earliest.
static inline svpwm_window_t svpwm_window_between(const sampling_config_t* c, int32_t begin, int32_t end,
                                                  unsigned state) {
  const svpwm_window_t w = {(int16_t)(begin + c->settle_ticks), (int16_t)q_min(end - c->burst_ticks, c->last_tick),
                            (uint16_t)state};
  return w;
}

/// A walk along the edges that finds the windows that tell most, in the order of time. Samples keep off edges that are
/// not certain: a window begins when the edges before it have come at the latest, and ends when those behind it can
/// come at the earliest.
typedef struct {
  int32_t shortest;      // interval worth a look, ticks
  int32_t begin, ended;  // of the interval, of the last window
  unsigned passed;       // bit k: edge k has
} svpwm_finder_t;

static inline svpwm_finder_t svpwm_finder(const sampling_config_t* c, svpwm_pattern_t* pattern) {
  const svpwm_finder_t f = {(int32_t)c->settle_ticks + c->burst_ticks + c->span_min_ticks, 0, 0, 0};
  pattern->window_count = 0;
  return f;
}

/// An edge that may come before the one that has ended the last window; a window that may be worth it, behind the edges
/// that have passed. Where two are kept a zero vector, which shows no saliency, counts a
/// quarter of its length.
void svpwm_shorten_window(const sampling_config_t* c, svpwm_pattern_t* pattern, int32_t end);
void svpwm_take_window(const sampling_config_t* c, svpwm_pattern_t* pattern, int32_t begin, int32_t end,
                       unsigned passed);

static inline void svpwm_finder_end_interval(svpwm_finder_t* f, const sampling_config_t* c, svpwm_pattern_t* pattern,
                                             int32_t end) {
  if (end - f->begin < f->shortest) return;  // most intervals are short
  svpwm_take_window(c, pattern, f->begin, end, f->passed);
  f->ended = end;
}

/// An edge comes from a tick on, and by another at the latest; both are the instant wanted where that is certain.
static inline void svpwm_finder_pass(svpwm_finder_t* f, const sampling_config_t* c, svpwm_pattern_t* pattern,
                                     unsigned edge, int32_t earliest, int32_t latest) {
  svpwm_finder_end_interval(f, c, pattern, earliest);
  f->begin = q_max(f->begin, latest);
  f->passed |= 1u << edge;
}

/// Before an edge that is not certain: it may come before the one that has ended the last window.
static inline void svpwm_finder_beware(const svpwm_finder_t* f, const sampling_config_t* c, svpwm_pattern_t* pattern,
                                       int32_t earliest) {
  if (earliest < f->ended) svpwm_shorten_window(c, pattern, earliest);
}

/// Behind the last edge: the period's end cuts some.
static inline void svpwm_finder_finish(svpwm_finder_t* f, const sampling_config_t* c, svpwm_pattern_t* pattern) {
  svpwm_finder_end_interval(f, c, pattern, SVPWM_PERIOD_TICKS);
}

#endif

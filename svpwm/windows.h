// Finds the intervals of constant switching state in a set of pulses and picks the three that are worth sampling.

#ifndef STILLSPIN_SVPWM_WINDOWS_H
#define STILLSPIN_SVPWM_WINDOWS_H

#include "svpwm/pattern.h"

typedef struct {
  int16_t settle_ticks;    // from an edge at the motor to the first sample, at least 400: ringing, and reading the last
                           // window
  int16_t burst_ticks;     // length of a burst of conversions
  int16_t span_min_ticks;  // shortest useful time between the two bursts
  int16_t last_tick;       // the last burst must have been triggered by here, so that it is read before the period ends
} sampling_config_t;

/// Fills windows and window_count of the pattern: the longest ones, in the order of time. Samples keep off edges that
/// are not certain: a window begins when the edges before it have come at the latest, and ends when those behind it can
/// come at the earliest.
void svpwm_find_windows(const sampling_config_t* c, const svpwm_arrival_t* arrival, svpwm_pattern_t* pattern);

/// Trigger instants of the two bursts of a window.
static inline int16_t svpwm_burst_start(const sampling_config_t* c, const svpwm_window_t* w) {
  return (int16_t)(w->begin + c->settle_ticks);
}
static inline int16_t svpwm_burst_end(const sampling_config_t* c, const svpwm_window_t* w) {
  const int16_t at_edge = (int16_t)(w->end - c->burst_ticks);
  return (at_edge < c->last_tick) ? at_edge : c->last_tick;
}

#endif

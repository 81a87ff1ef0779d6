#include "svpwm/windows.h"

#define EDGES (2u * SVPWM_LEGS)

typedef struct {
  int16_t tick;
  uint16_t leg_bit;
} edge_t;

static void sort_edges(const svpwm_pulses_t* p, edge_t edges[EDGES]) {
  uint16_t count = 0;
  for (uint16_t k = 0; k < EDGES; k++) {
    const uint16_t leg = (uint16_t)(k >> 1);
    const edge_t e = {((k & 1u) != 0u) ? p->fall[leg] : p->rise[leg], (uint16_t)(1u << leg)};
    uint16_t n = count;
    while (n > 0u && edges[n - 1u].tick > e.tick) {
      edges[n] = edges[n - 1u];
      n--;
    }
    edges[n] = e;
    count++;
  }
}

static int16_t span(const sampling_config_t* c, const svpwm_window_t* w) {
  return (int16_t)(svpwm_burst_end(c, w) - svpwm_burst_start(c, w));
}

// Drops the shortest window, keeping the order of time.
static void drop_shortest(const sampling_config_t* c, svpwm_window_t w[], uint16_t count) {
  uint16_t shortest = 0;
  for (uint16_t k = 1; k < count; k++) {
    if (span(c, &w[k]) < span(c, &w[shortest])) shortest = k;
  }
  for (uint16_t k = shortest; k + 1u < count; k++) w[k] = w[k + 1u];
}

void svpwm_find_windows(const sampling_config_t* c, svpwm_pattern_t* pattern) {
  edge_t edges[EDGES];
  svpwm_window_t found[SVPWM_WINDOWS + 1];
  svpwm_window_t w = {0, 0, 0};
  uint16_t count = 0;
  sort_edges(&pattern->pulses, edges);
  for (uint16_t k = 0; k <= EDGES; k++) {
    w.end = (k < EDGES) ? edges[k].tick : SVPWM_PERIOD_TICKS;
    if (span(c, &w) >= c->span_min_ticks) {
      found[count] = w;
      count++;
      if (count > SVPWM_WINDOWS) {
        drop_shortest(c, found, count);
        count = SVPWM_WINDOWS;
      }
    }
    w.begin = w.end;
    if (k < EDGES) w.state ^= edges[k].leg_bit;
  }
  pattern->window_count = count;
  for (uint16_t k = 0; k < count; k++) pattern->windows[k] = found[k];
}

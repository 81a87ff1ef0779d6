#include "svpwm/windows.h"

#define EDGES (2u * SVPWM_LEGS)

// An edge as its tick and, in the three bits below, the leg that changes: sorted as one number.
static uint32_t edge_of(int16_t tick, uint16_t leg) { return ((uint32_t)(uint16_t)tick << 3) | (1uL << leg); }

static void put_in_order(uint32_t* a, uint32_t* b) {
  const uint32_t low = (*a < *b) ? *a : *b;
  *b = (*a < *b) ? *b : *a;
  *a = low;
}

static void sort_three(uint32_t e[3]) {
  put_in_order(&e[1], &e[2]);
  put_in_order(&e[0], &e[2]);
  put_in_order(&e[0], &e[1]);
}

// Sorting network: twelve comparisons for six numbers, whatever their order.
static void sort_edges(const svpwm_pulses_t* p, uint32_t e[EDGES]) {
  for (uint16_t k = 0; k < SVPWM_LEGS; k++) {
    e[k] = edge_of(p->rise[k], k);
    e[k + SVPWM_LEGS] = edge_of(p->fall[k], k);
  }
  sort_three(&e[0]);
  sort_three(&e[3]);
  put_in_order(&e[2], &e[5]);
  put_in_order(&e[0], &e[3]);
  put_in_order(&e[1], &e[4]);
  put_in_order(&e[2], &e[4]);
  put_in_order(&e[1], &e[3]);
  put_in_order(&e[2], &e[3]);
}

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

void svpwm_find_windows(const sampling_config_t* c, svpwm_pattern_t* pattern) {
  const int16_t shortest = (int16_t)(c->settle_ticks + c->burst_ticks + c->span_min_ticks);
  uint32_t edges[EDGES + 1u];
  int16_t begin = 0;
  uint16_t state = 0;
  uint16_t count = 0;
  sort_edges(&pattern->pulses, edges);
  edges[EDGES] = (uint32_t)SVPWM_PERIOD_TICKS << 3;
  for (uint16_t k = 0; k <= EDGES; k++) {
    const int16_t end = (int16_t)(edges[k] >> 3);
    // Most intervals are short; the period's end cuts some of the others.
    if (end - begin >= shortest) {
      const svpwm_window_t w = {begin, end, state};
      if (span(c, &w) >= c->span_min_ticks) count = take(c, pattern->windows, count, &w);
    }
    begin = end;
    state ^= (uint16_t)(edges[k] & 7u);
  }
  pattern->window_count = count;
}

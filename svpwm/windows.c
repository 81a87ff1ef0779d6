#include "svpwm/windows.h"

#define ZERO_SHIFT 2u

static int32_t worth(const svpwm_window_t* w, unsigned zero_shift) {
  const int32_t span = (int32_t)w->end - w->start;
  return svpwm_is_zero_vector(w->state) ? q_shr(span, zero_shift) : span;
}

// One more than are kept: that which tells least goes, and the later ones move up.
static void leave_one_out(svpwm_window_t w[], uint16_t kept) {
  const unsigned zero_shift = (kept < SVPWM_WINDOWS) ? ZERO_SHIFT : 0u;
  uint16_t least = 0;
  int32_t least_worth = worth(&w[0], zero_shift);
  for (uint16_t k = 1; k <= kept; k++) {
    const int32_t own = worth(&w[k], zero_shift);
    if (own >= least_worth) continue;
    least_worth = own;
    least = k;
  }
  for (; least < kept; least++) w[least] = w[least + 1u];
}

void svpwm_take_window(const sampling_config_t* c, svpwm_pattern_t* pattern, int32_t begin, int32_t end,
                       unsigned passed) {
  svpwm_window_t* const next = &pattern->windows[pattern->window_count];
  *next = svpwm_window_between(c, begin, end, (passed ^ (passed >> SVPWM_LEGS)) & 7u);
  if (next->end < next->start + c->span_min_ticks) return;
  if (pattern->window_count < c->windows) {
    pattern->window_count++;
  } else {
    leave_one_out(pattern->windows, c->windows);
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

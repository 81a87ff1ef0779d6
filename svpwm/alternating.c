#include "svpwm/alternating.h"

static void advance(alternating_state_t* s) {
  s->leg++;
  if (s->leg < SVPWM_LEGS) return;
  s->leg = 0u;
  s->pair_first = !s->pair_first;
}

typedef struct {
  uint16_t x, longer, shorter;
  int32_t on_x, on_longer, on_shorter;
} lengths_t;

static void put_pair_first(svpwm_pulses_t* p, const lengths_t* l) {
  svpwm_put_pulse(p, l->longer, SVPWM_FIRST_TICK, l->on_longer);
  svpwm_put_pulse(p, l->shorter, SVPWM_FIRST_TICK, l->on_shorter);
  svpwm_put_pulse(p, l->x, SVPWM_LAST_TICK - l->on_x, l->on_x);
  svpwm_put_order(p, l->longer, l->shorter, svpwm_fall_of(l->shorter), svpwm_fall_of(l->longer), l->x,
                  svpwm_fall_of(l->x));
}

static void put_pair_last(svpwm_pulses_t* p, const lengths_t* l) {
  svpwm_put_pulse(p, l->x, SVPWM_FIRST_TICK, l->on_x);
  svpwm_put_pulse(p, l->longer, SVPWM_LAST_TICK - l->on_longer, l->on_longer);
  svpwm_put_pulse(p, l->shorter, SVPWM_LAST_TICK - l->on_shorter, l->on_shorter);
  svpwm_put_order(p, l->x, svpwm_fall_of(l->x), l->longer, l->shorter, svpwm_fall_of(l->longer),
                  svpwm_fall_of(l->shorter));
}

// The pulse of x and the longer one of the pair add up to 9401 ticks at most: they do not meet.
static lengths_t lengths_with(uint16_t x, const svpwm_on_time_t* t, int16_t pulse_ticks) {
  lengths_t l;
  l.x = x;
  l.longer = (x == t->hi) ? t->mid : t->hi;
  l.shorter = (x == t->lo) ? t->mid : t->lo;
  // The common part that makes the lengths of the two pulses add up to twice the mean.
  const int32_t common = pulse_ticks - (t->leg[x] + t->leg[l.longer]) / 2;
  l.on_x = common + t->leg[x];
  l.on_longer = common + t->leg[l.longer];
  l.on_shorter = common + t->leg[l.shorter];
  return l;
}

void svpwm_alternating(alternating_state_t* s, const svpwm_on_time_t* t, int16_t pulse_ticks, svpwm_pulses_t* pulses) {
  const lengths_t l = lengths_with(s->leg, t, pulse_ticks);
  const bool pair_first = s->pair_first;
  advance(s);
  if (pair_first) {
    put_pair_first(pulses, &l);
  } else {
    put_pair_last(pulses, &l);
  }
}

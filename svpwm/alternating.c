#include "svpwm/alternating.h"

static void advance(alternating_state_t* s) {
  s->leg = (uint16_t)((s->leg + 1u) % SVPWM_LEGS);
  if (s->leg == 0u) s->pair_first = !s->pair_first;
}

static void put_first(svpwm_pulses_t* p, uint16_t leg, int16_t length) {
  p->at[leg] = SVPWM_FIRST_TICK;
  p->at[svpwm_fall_of(leg)] = (int16_t)(SVPWM_FIRST_TICK + length);
}

static void put_last(svpwm_pulses_t* p, uint16_t leg, int16_t length) {
  p->at[leg] = (int16_t)(SVPWM_LAST_TICK - length);
  p->at[svpwm_fall_of(leg)] = SVPWM_LAST_TICK;
}

// The pulse of x and the longer one of the pair add up to 9401 ticks at most: they do not meet.
void svpwm_alternating(alternating_state_t* s, const svpwm_on_time_t* t, int16_t pulse_ticks, svpwm_pulses_t* pulses) {
  const uint16_t x = s->leg;
  const uint16_t longer = (x == t->hi) ? t->mid : t->hi;
  const uint16_t shorter = (x == t->lo) ? t->mid : t->lo;
  // The common part that makes the lengths of the two pulses add up to twice the mean.
  const int16_t common = (int16_t)(pulse_ticks - (t->leg[x] + t->leg[longer]) / 2);
  const int16_t on_x = (int16_t)(common + t->leg[x]);
  const int16_t on_longer = (int16_t)(common + t->leg[longer]);
  const int16_t on_shorter = (int16_t)(common + t->leg[shorter]);
  if (s->pair_first) {
    put_first(pulses, longer, on_longer);
    put_first(pulses, shorter, on_shorter);
    put_last(pulses, x, on_x);
    pulses->order = svpwm_order(longer, shorter, svpwm_fall_of(shorter), svpwm_fall_of(longer), x, svpwm_fall_of(x));
  } else {
    put_first(pulses, x, on_x);
    put_last(pulses, longer, on_longer);
    put_last(pulses, shorter, on_shorter);
    pulses->order = svpwm_order(x, svpwm_fall_of(x), longer, shorter, svpwm_fall_of(longer), svpwm_fall_of(shorter));
  }
  advance(s);
}

bool svpwm_alternating_fits(const svpwm_on_time_t* t, int16_t pulse_ticks) {
  return 10L * (t->leg[t->hi] - t->leg[t->lo]) < 7L * pulse_ticks;
}

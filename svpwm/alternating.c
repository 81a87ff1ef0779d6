#include "svpwm/alternating.h"

// A pulse of `length` at the beginning or at the end of the room.
static void place(svpwm_pulses_t* p, uint16_t leg, int16_t length, bool at_begin) {
  p->rise[leg] = at_begin ? SVPWM_FIRST_TICK : (int16_t)(SVPWM_LAST_TICK - length);
  p->fall[leg] = (int16_t)(p->rise[leg] + length);
}

static void advance(alternating_state_t* s) {
  s->leg = (uint16_t)((s->leg + 1u) % SVPWM_LEGS);
  if (s->leg == 0u) s->pair_first = !s->pair_first;
}

void svpwm_alternating(alternating_state_t* s, const svpwm_on_time_t* t, int16_t pulse_ticks, svpwm_pulses_t* pulses) {
  const uint16_t x = s->leg;
  const uint16_t y = (uint16_t)((x + 1u) % SVPWM_LEGS);
  const uint16_t z = (uint16_t)((x + 2u) % SVPWM_LEGS);
  const int16_t pair = q_max16(t->leg[y], t->leg[z]);
  // The common part that makes the lengths of the two pulses add up to twice the mean.
  const int16_t common = (int16_t)(pulse_ticks - (t->leg[x] + pair) / 2);
  place(pulses, x, (int16_t)(common + t->leg[x]), !s->pair_first);
  place(pulses, y, (int16_t)(common + t->leg[y]), s->pair_first);
  place(pulses, z, (int16_t)(common + t->leg[z]), s->pair_first);
  advance(s);
}

bool svpwm_alternating_fits(const svpwm_on_time_t* t, int16_t pulse_ticks) {
  const int16_t high = q_max16(t->leg[0], q_max16(t->leg[1], t->leg[2]));
  const int16_t low = q_min16(t->leg[0], q_min16(t->leg[1], t->leg[2]));
  return (int16_t)(high - low) < pulse_ticks / 10 * 7;
}

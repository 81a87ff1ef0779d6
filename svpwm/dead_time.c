#include "svpwm/dead_time.h"

#include "svpwm/ripple.h"

// Sign of a current as -1..1, Q15, linear inside the band.
static int32_t sign_q15(int32_t current_q20, int32_t band_q20) {
  if (current_q20 >= band_q20) return 32767L;
  if (current_q20 <= -band_q20) return -32767L;
  return q_div(current_q20, band_q20, 15);
}

// Delay of an edge, ticks; `sign` is positive where the current blocks the edge.
static int16_t delay_ticks(const dead_time_config_t* c, int32_t blocking_q15) {
  const int32_t middle = c->blocked_ticks + c->released_ticks;
  const int32_t half_range = c->blocked_ticks - c->released_ticks;
  return (int16_t)q_shr_round(middle * (int32_t)32768 + half_range * blocking_q15, 16);
}

static int32_t current_at(const svpwm_pulses_t* p, uint16_t leg, int16_t tick, ab_t mean_q20, int32_t admittance_q30,
                          int32_t link_q16) {
  const ab_t flux_q16 = svpwm_ripple_q16(p, tick, link_q16);
  const ab_t i_q20 = {mean_q20.alpha + q_mul(flux_q16.alpha, admittance_q30, 26),
                      mean_q20.beta + q_mul(flux_q16.beta, admittance_q30, 26)};
  const abc_t phases = frame_inverse_clarke(i_q20);
  return (leg == 0u) ? phases.a : (leg == 1u) ? phases.b : phases.c;
}

void dead_time_compensate(const dead_time_config_t* c, const svpwm_pulses_t* wanted, ab_t current_q20,
                          int32_t admittance_q30, int32_t link_q16, svpwm_pulses_t* command) {
  for (uint16_t leg = 0; leg < SVPWM_LEGS; leg++) {
    const int32_t at_rise = current_at(wanted, leg, wanted->rise[leg], current_q20, admittance_q30, link_q16);
    const int32_t at_fall = current_at(wanted, leg, wanted->fall[leg], current_q20, admittance_q30, link_q16);
    command->rise[leg] = (int16_t)(wanted->rise[leg] - delay_ticks(c, sign_q15(at_rise, c->band_q20)));
    command->fall[leg] = (int16_t)(wanted->fall[leg] - delay_ticks(c, -sign_q15(at_fall, c->band_q20)));
  }
}

ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20) {
  const abc_t i = frame_inverse_clarke(current_q20);
  const abc_t drop = {q_mul(sign_q15(i.a, c->band_q20), c->drop_q16, 15),
                      q_mul(sign_q15(i.b, c->band_q20), c->drop_q16, 15),
                      q_mul(sign_q15(i.c, c->band_q20), c->drop_q16, 15)};
  return frame_clarke3(drop);
}

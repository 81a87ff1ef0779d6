#include "svpwm/modulator.h"

#define FOUR_FIFTHS_Q15 26214u
#define ONE_Q15 32768u

void modulator_reset(modulator_t* s) {
  s->alternating.leg = 0;
  s->alternating.pair_first = false;
  s->is_alternating = true;
  s->ticks_per_volt_q20 = 0;
}

// Leaves the alternating layout at its limit and comes back with a fifth to spare.
static bool alternate(const modulator_t* s, const modulator_config_t* c, const svpwm_on_time_t* t) {
  const int16_t pulse =
      s->is_alternating ? c->pulse_ticks : (int16_t)((uint32_t)c->pulse_ticks * FOUR_FIFTHS_Q15 / ONE_Q15);
  return svpwm_alternating_fits(t, pulse);
}

modulator_result_t modulator_step(modulator_t* s, const modulator_config_t* c, excitation_t excitation,
                                  ab_t voltage_q16, int32_t link_q16, svpwm_pulses_t* pulses) {
  s->ticks_per_volt_q20 = svpwm_ticks_per_volt_q20(link_q16, s->ticks_per_volt_q20);
  const svpwm_on_time_t t = svpwm_on_time(voltage_q16, s->ticks_per_volt_q20);
  const bool opposite = excitation == EXCITATION_ALTERNATING || excitation == EXCITATION_CHEAPEST;
  s->is_alternating = opposite && alternate(s, c, &t);
  if (s->is_alternating) {
    svpwm_alternating(&s->alternating, &t, c->pulse_ticks, pulses);
  } else if (excitation == EXCITATION_CENTRED) {
    svpwm_centred(&t, pulses);
  } else if (excitation == EXCITATION_LONG_ZERO) {
    svpwm_long_zero(&t, pulses);
  } else if (excitation == EXCITATION_CHEAPEST) {
    svpwm_cheapest_pair(&c->extended, &t, pulses);
  } else {
    svpwm_extended(&c->extended, &t, pulses);
  }
  const modulator_result_t result = {t.realised_q16, t.limited};
  return result;
}

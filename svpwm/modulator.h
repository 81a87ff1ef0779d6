// The modulator: from a voltage vector to three pulses, with the layout that the estimator wants.

#ifndef STILLSPIN_SVPWM_MODULATOR_H
#define STILLSPIN_SVPWM_MODULATOR_H

#include "svpwm/alternating.h"
#include "svpwm/extended.h"
#include "svpwm/windows.h"

typedef enum {
  EXCITATION_CENTRED = 0,      // plain SVPWM
  EXCITATION_EXTENDED = 1,     // two active vectors and a zero vector of at least T_min each
  EXCITATION_ALTERNATING = 2,  // two long opposite vectors while the voltage allows, extended above
  EXCITATION_LONG_ZERO = 4,    // all pulses as short as they can be, then one zero vector: what ZVV alone runs on best
  EXCITATION_CHEAPEST = 5      // as alternating, but above its limit the pair that costs least
} excitation_t;

typedef struct {
  extended_config_t extended;
  sampling_config_t sampling;
  int16_t pulse_ticks;  // mean pulse of the alternating layout, 1500..4700
} modulator_config_t;

typedef struct {
  alternating_state_t alternating;
  bool is_alternating;         // layout of the last period
  int32_t ticks_per_volt_q20;  // of its DC link
} modulator_t;

typedef struct {
  ab_t realised_q16;  // mean voltage that the pattern gives, V
  bool limited;       // the command did not fit and was shortened in its direction
} modulator_result_t;

void modulator_reset(modulator_t* s);

modulator_result_t modulator_step(modulator_t* s, const modulator_config_t* c, excitation_t excitation,
                                  ab_t voltage_q16, int32_t link_q16, svpwm_pulses_t* pulses);

#endif

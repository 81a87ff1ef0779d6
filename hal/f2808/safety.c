#include <stddef.h>

#include "hal/f2808/f2808_values.h"
#include "hal/f2808/gpio.h"
#include "hal/f2808/pwm_modules.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_replay.h"
#include "hal/hal_safety.h"

#define TRIP_BY_COMPARATOR ((uint16_t)(EPWM_TZSEL_OSHT1_MASK << (BOARD_TRIP_INPUT - 1u)))

void hal_safety_init(void) {
  gpio_make_output(BOARD_PIN_GATE_ENABLE, false);
  gpio_make_output(BOARD_PIN_FAULT_LAMP, BOARD_LAMP_ON_LEVEL == 0u);
  // Asynchronous: the trip must also work when the clock has stopped, and not wait for samples.
  gpio_connect(BOARD_PIN_OVER_CURRENT);
  target_eallow();
  for (uint16_t module = PWM_FIRST_LEG_MODULE; module < PWM_FIRST_LEG_MODULE + HAL_PWM_LEGS; module++) {
    target_write16(EPWM_BASE(module) + EPWM_TZSEL, TRIP_BY_COMPARATOR);
  }
  target_write16(EPWM_BASE(PWM_TRIP_WITNESS_MODULE) + EPWM_TZSEL, TRIP_BY_COMPARATOR);
  target_edis();
}

void hal_safety_toggle_enable(void) {
  if (!replay_is_off()) {
    replay_output(REPLAY_ENABLE, NULL, 0u);
    replay_call();
  }
  if (!replay_plays()) gpio_toggle(BOARD_PIN_GATE_ENABLE);
}

void hal_safety_fault_lamp(bool lit) {
  const uint16_t word = lit ? 1u : 0u;
  replay_output(REPLAY_LAMP, &word, 1u);
  replay_call();
  gpio_write(BOARD_PIN_FAULT_LAMP, lit == (BOARD_LAMP_ON_LEVEL != 0u));
}

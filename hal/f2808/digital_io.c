#include "hal/f2808/f2808_values.h"
#include "hal/f2808/gpio.h"
#include "hal/f2808/pwm_modules.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_replay.h"

#define TRIP_BY_EMERGENCY ((uint16_t)(EPWM_TZSEL_OSHT1_MASK << (BOARD_EMERGENCY_TRIP - 1u)))

void hal_digital_io_init(void) {
  gpio_make_output(BOARD_PIN_RELAY, BOARD_RELAY_ON_LEVEL == 0u);
  gpio_make_output(BOARD_PIN_BRAKE, BOARD_BRAKE_ON_LEVEL == 0u);
}

void hal_digital_io_relay(bool on) { gpio_write(BOARD_PIN_RELAY, on == (BOARD_RELAY_ON_LEVEL != 0u)); }

void hal_digital_io_brake(bool on) { gpio_write(BOARD_PIN_BRAKE, on == (BOARD_BRAKE_ON_LEVEL != 0u)); }

// The legs alone: the witness tells the comparator's trips from all others.
void hal_digital_io_wire_emergency(void) {
  gpio_connect(BOARD_PIN_EMERGENCY);
  target_eallow();
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    const uint32_t select = EPWM_BASE(PWM_FIRST_LEG_MODULE + leg) + EPWM_TZSEL;
    target_write16(select, (uint16_t)(target_read16(select) | TRIP_BY_EMERGENCY));
  }
  target_edis();
}

bool hal_digital_io_emergency(void) {
  replay_call();
  return replay_plays() ? replay_take() != 0u : replay_note((uint16_t)(gpio_read(BOARD_PIN_EMERGENCY) ? 0u : 1u)) != 0u;
}

bool hal_digital_io_run(void) { return !gpio_read(BOARD_PIN_RUN); }

bool hal_digital_io_gates_pass(void) { return gpio_read(BOARD_PIN_GATE_FEEDBACK); }

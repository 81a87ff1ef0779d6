// The board's plain lines: what it switches and what it tells, beside the gates (hal_pwm.h, hal_safety.h). The board's
// file (hal_board.h) says which pins they are and which level means what. Background level, but where it says so.

#ifndef STILLSPIN_HAL_HAL_DIGITAL_IO_H
#define STILLSPIN_HAL_HAL_DIGITAL_IO_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

// Makes relay and brake resistor outputs, both off. Until then their pins are inputs, as after a reset, and the board
// holds both off.
void hal_digital_io_init(void);
void hal_digital_io_relay(bool on);
void hal_digital_io_brake(bool on);

// Lets the emergency stop switch the gates off in hardware, as the over-current comparator does.
void hal_digital_io_wire_emergency(void);

// Whether it is pressed, or its wire broken. From any level.
bool hal_digital_io_emergency(void);

// The switch that asks the drive to run.
bool hal_digital_io_run(void);

// Whether the gate enable passes the gates now.
bool hal_digital_io_gates_pass(void);

#ifdef __cplusplus
}
#endif

#endif

// What protects the power stage without software, and the board's two safety lines.
//
// The over-current comparator pulls its input low and thereby switches all gates off in hardware, without a clock and
// without the CPU; they stay off until hal_pwm_gates_on. The gate enable line passes the gates only while it is being
// toggled, so a stopped program switches them off as well.

#ifndef STILLSPIN_HAL_HAL_SAFETY_H
#define STILLSPIN_HAL_HAL_SAFETY_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

// Connects the over-current input to the gates, and makes the enable line (low) and the fault lamp (dark) outputs.
// Needs hal_clock_init; call it before hal_pwm_gates_on, before or after hal_pwm_init.
void hal_safety_init(void);

// Toggles the gate enable line; call it once a period while the drive is well.
void hal_safety_toggle_enable(void);

// Lights the fault lamp or switches it off.
void hal_safety_fault_lamp(bool lit);

#ifdef __cplusplus
}
#endif

#endif

// An analogue torque limit: a voltage of 0 to 3 V at the board's speed input lets the drive have as much of
// current_limit. For boards that take no speed from there (speed_input 0).

#ifndef TORQUE_LIMIT_H
#define TORQUE_LIMIT_H

#include <stdint.h>

#include "firmware/api/status.h"

void torque_limit_reset(void);

/// Background level, in every pass.
void torque_limit_service(void);

/// Of current_limit what the voltage leaves (firmware/mode/interlock.h).
int32_t torque_limit_share(void);

extern const status_line_t torque_limit_line;

#endif

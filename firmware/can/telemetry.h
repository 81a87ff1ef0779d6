// Contents of the messages that tell how the drive is, from the signals of one control interrupt.

#ifndef STILLSPIN_FIRMWARE_CAN_TELEMETRY_H
#define STILLSPIN_FIRMWARE_CAN_TELEMETRY_H

#include "firmware/can/command.h"
#include "hal/hal_can.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Fills STATUS.
void telemetry_status(hal_can_frame_t* frame, const can_command_t* command, uint16_t alive);

/// Fills TELEMETRY_1 and TELEMETRY_2.
void telemetry_values(hal_can_frame_t* first, hal_can_frame_t* second);

#if defined(__cplusplus)
}
#endif

#endif

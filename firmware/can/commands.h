// The console's commands of the CAN bus.

#ifndef STILLSPIN_FIRMWARE_CAN_COMMANDS_H
#define STILLSPIN_FIRMWARE_CAN_COMMANDS_H

#include "firmware/console/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

void command_can(const words_of_line_t* a);

#if defined(__cplusplus)
}
#endif

#endif

// The console's commands of the commissioning.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_COMMANDS_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_COMMANDS_H

#include "firmware/console/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

void command_commission(const words_of_line_t* a);

#if defined(__cplusplus)
}
#endif

#endif

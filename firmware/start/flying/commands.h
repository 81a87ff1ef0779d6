// The console's command of a look at the shaft.

#ifndef STILLSPIN_FIRMWARE_START_FLYING_COMMANDS_H
#define STILLSPIN_FIRMWARE_START_FLYING_COMMANDS_H

#include "firmware/console/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

void command_look(const words_of_line_t* a);

#if defined(__cplusplus)
}
#endif

#endif

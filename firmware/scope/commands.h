// The console's commands of the scope.

#ifndef STILLSPIN_FIRMWARE_SCOPE_COMMANDS_H
#define STILLSPIN_FIRMWARE_SCOPE_COMMANDS_H

#include "firmware/console/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

void command_scope(const words_of_line_t* a);

#if defined(__cplusplus)
}
#endif

#endif

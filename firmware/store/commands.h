// The console's commands of the parameter store.

#ifndef STILLSPIN_FIRMWARE_STORE_COMMANDS_H
#define STILLSPIN_FIRMWARE_STORE_COMMANDS_H

#include "firmware/console/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

void command_save(const words_of_line_t* a);
void command_load(const words_of_line_t* a);
void command_defaults(const words_of_line_t* a);
extern const status_line_t store_line;

#if defined(__cplusplus)
}
#endif

#endif

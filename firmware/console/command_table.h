// The commands by their places in all_commands.h.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_COMMAND_TABLE_H
#define STILLSPIN_FIRMWARE_CONSOLE_COMMAND_TABLE_H

#include "firmware/console/words_of_line.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define PLACE(number)
#define COMMAND(name, arguments, help) +1
enum {
  COMMANDS = 0
#include "firmware/console/all_commands.h"
};
#undef COMMAND
#undef PLACE

typedef void command_function_t(const words_of_line_t* a);

/// PACKED_NONE behind the last one.
packed_text_t command_name(uint16_t command);
/// Those of the edition by their places in the list, NULL where it has not that command (editions/).
extern command_function_t* const edition_commands[];
bool command_is_here(uint16_t command);

packed_text_t command_arguments(uint16_t command);
packed_text_t command_meaning(uint16_t command);

/// COMMANDS when there is none of that name.
uint16_t command_find(const word_t* name);

#if defined(__cplusplus)
}
#endif

#endif

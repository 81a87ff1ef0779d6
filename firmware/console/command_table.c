#include "firmware/console/command_table.h"

#include <stddef.h>

// The texts stand in the list's order.
static packed_text_t text_of(packed_text_t first, uint16_t command) { return (packed_text_t)(first + command); }

packed_text_t command_name(uint16_t command) {
  return (command < COMMANDS) ? text_of(TEXT_COMMAND_NAME_help, command) : PACKED_NONE;
}

bool command_is_here(uint16_t command) { return command < COMMANDS && edition_commands[command] != NULL; }

packed_text_t command_arguments(uint16_t command) { return text_of(TEXT_COMMAND_ARGUMENTS_help, command); }

packed_text_t command_meaning(uint16_t command) { return text_of(TEXT_COMMAND_help, command); }

uint16_t command_find(const word_t* name) {
  return packed_find(TEXT_COMMAND_NAME_help, COMMANDS, name->text, name->count);
}

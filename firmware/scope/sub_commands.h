// Parts of the console's scope command, each with the words behind its own.

#ifndef STILLSPIN_FIRMWARE_SCOPE_SUB_COMMANDS_H
#define STILLSPIN_FIRMWARE_SCOPE_SUB_COMMANDS_H

#include "firmware/console/words_of_line.h"
#include "firmware/text/packed_text.h"

// commands_setup.c
void scope_set_channels(const words_of_line_t* a);
void scope_set_trigger(const words_of_line_t* a);
void scope_set_every(const words_of_line_t* a);
void scope_set_before(const words_of_line_t* a);
void scope_set_mode(const words_of_line_t* a);

// commands_show.c
void scope_show(void);
void scope_print(const words_of_line_t* a);

/// Word of a scope_edge_t.
static inline packed_text_t scope_edge_text(uint16_t edge) { return (packed_text_t)(SAY_edge_rising + edge); }

/// The whole number behind the sub-command. False, and said, when it is none of least .. most.
bool scope_whole(const words_of_line_t* a, uint16_t least, uint16_t most, uint16_t* value);

#endif

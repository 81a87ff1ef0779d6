// Parts of the console's scope command, each with the words behind its own and the set-up that it starts from. True:
// the set-up is to be taken over.

#ifndef STILLSPIN_FIRMWARE_SCOPE_SUB_COMMANDS_H
#define STILLSPIN_FIRMWARE_SCOPE_SUB_COMMANDS_H

#include "firmware/console/words_of_line.h"
#include "firmware/scope/scope.h"
#include "firmware/text/packed_text.h"

// commands_setup.c
bool scope_set_channels(const words_of_line_t* a, scope_setup_t* s);
bool scope_set_trigger(const words_of_line_t* a, scope_setup_t* s);
bool scope_set_hysteresis(const words_of_line_t* a, scope_setup_t* s);
bool scope_set_every(const words_of_line_t* a, scope_setup_t* s);
bool scope_set_before(const words_of_line_t* a, scope_setup_t* s);
bool scope_set_mode(const words_of_line_t* a, scope_setup_t* s);

// commands_show.c
void scope_show(void);
bool scope_print(const words_of_line_t* a, scope_setup_t* s);

/// Word of a scope_edge_t.
static inline packed_text_t scope_edge_text(uint16_t edge) { return (packed_text_t)(SAY_edge_rising + edge); }

/// The whole number behind the sub-command. False, and said, when it is none of least .. most.
bool scope_whole(const words_of_line_t* a, uint16_t least, uint16_t most, uint16_t* value);

#endif

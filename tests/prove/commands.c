// The console's commands, each with any words behind it, and the lines of their answers until none is left.

#include "firmware/console/commands.h"

#include "firmware/api/status.h"
#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/can/commands.h"
#include "firmware/can/node.h"
#include "firmware/commissioning/commands.h"
#include "firmware/console/console.h"
#include "firmware/console/suggest/suggest.h"
#include "firmware/link/link.h"
#include "firmware/scope/commands.h"
#include "firmware/start/flying/commands.h"
#include "firmware/store/commands.h"
#include "hal/hal_sci.h"
#include "tests/prove/any_drive.h"

#define COMMAND(name, arguments, help) command_##name,
command_function_t* const edition_commands[] = {
#include "firmware/console/all_commands.h"
};
#undef COMMAND
suggest_t* const edition_suggest = suggest_names;
const status_line_t* const edition_status_lines[] = {&state_line,    &speed_line, &current_line,    &dc_link_line,
                                                     &limits_line,   &fault_line, &parameters_line, &board_line,
                                                     &selftest_line, &store_line, &serial_line,     0};

// Without room nothing happens.
uint16_t hal_sci_room(void) { return HAL_SCI_TRANSMIT_RING; }

can_node_state_t can_node_state(void) {
  can_node_state_t s;
  s.node = any_u16;
  s.rate_kbit = any_i32;
  s.heard = any_bool();
  s.commanding = any_bool();
  s.timed_out = any_bool();
  s.bus.state = (hal_can_state_t)any_up_to(5);
  s.bus.transmit_errors = any_u16;
  s.bus.receive_errors = any_u16;
  s.bus.lost = any_u16;
  s.bus.bus_offs = any_u16;
  s.bus.restarts = any_u16;
  s.bad_commands = any_u16;
  s.lost = any_u16;
  return s;
}

link_errors_t link_errors(void) {
  const link_errors_t e = {{any_u16, any_u16, any_u16}, hal_sci_errors(), any_u16};
  return e;
}

static words_of_line_t any_words(void) {
  static uint16_t typed[EDITOR_LINE];
  words_of_line_t a;
  any_octets(typed, EDITOR_LINE);
  for (uint16_t k = 0; k < COMMAND_WORDS; k++) {
    a.word[k].text = typed;
    a.word[k].count = (uint16_t)any_from(1, (int32_t)EDITOR_LINE);
  }
  a.count = any_up_to(COMMAND_WORDS);
  a.expired = any_bool();
  return a;
}

static void one_command(uint16_t command) {
  const words_of_line_t a = any_words();
  console_reset();
  any_moment();
  feature_status.stepped = any_bool();
  edition_commands[command](&a);
  // Lines with a place in a table of their own come first: each by itself.
  //@ loop unroll 24;
  for (uint16_t line = 0; line < 24u; line++) {
    any_moment();
    console_service();
  }
  while (any_bool()) {
    any_moment();
    console_service();
  }
}

// What is looked for among the names is set before anything looks: a word of nobody would stand beside that.
static void look_for_something(void) {
  const words_of_line_t a = any_words();
  suggest_names(NAME_COMMAND, &a.word[0]);
}

void prove_commands(void) {
  look_for_something();
  //@ loop unroll 40;
  for (uint16_t k = 0; command_name(k) != PACKED_NONE; k++) one_command(k);
}

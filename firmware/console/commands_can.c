// can: how the node of the CAN bus is.

#include "firmware/can/node.h"
#include "firmware/console/commands.h"
#include "firmware/console/console.h"
#include "firmware/console/output.h"
#include "firmware/text.h"
#include "firmware/words.h"

static can_node_state_t now;  // one moment for all lines

static void put_count(octet_writer_t* w, uint16_t count, const char* what) {
  put_unsigned(w, count);
  put_text(w, what);
}

static void line_bus(octet_writer_t* w) {
  put_text(w, "bus         node ");
  put_unsigned(w, now.node);
  if (now.rate_kbit > 0) {
    put_text(w, " at ");
    put_unsigned(w, (uint32_t)now.rate_kbit);
    put_text(w, " kbit/s");
  }
  put_text(w, ": ");
  put_words(w, WORDS_CAN, (uint16_t)now.bus.state);
}

static void line_errors(octet_writer_t* w) {
  put_text(w, "errors      ");
  put_count(w, now.bus.transmit_errors, " sending, ");
  put_count(w, now.bus.receive_errors, " receiving (96 warn, 256 sending are bus-off); bus-off ");
  put_count(w, now.bus.bus_offs, " times, restarted ");
  put_count(w, now.bus.restarts, " times");
}

static void line_lost(octet_writer_t* w) {
  put_text(w, "lost        ");
  put_count(w, now.lost, " frames or records; ");
  put_count(w, now.bad_commands, " commands did not count");
}

static void line_command(octet_writer_t* w) {
  const char* how = "none has come";
  if (now.heard) how = "they come; the drive was not started by them";
  if (now.commanding) how = "they command the drive";
  if (now.timed_out) how = "they stay away (can_timeout)";
  put_text(w, "commands    ");
  put_text(w, how);
}

static void (*const lines[])(octet_writer_t* w) = {line_bus, line_errors, line_lost, line_command};

#define LINES ((uint16_t)(sizeof lines / sizeof lines[0]))

static bool show(uint16_t step) {
  lines[step](line_begin());
  line_end();
  return step + 1u < LINES;
}

void command_can(const words_of_line_t* a) {
  (void)a;
  now = can_node_state();
  console_run(show, false);
}

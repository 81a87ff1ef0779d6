// can: how the node of the CAN bus is.

#include "firmware/can/commands.h"

#include "firmware/can/node.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

static can_node_state_t now;  // one moment for all lines

static void line_bus(octet_writer_t* w) {
  put_packed(w, SAY_bus_node);
  put_unsigned(w, now.node);
  if (now.rate_kbit > 0) {
    put_packed(w, SAY_at);
    put_count(w, (uint32_t)now.rate_kbit, SAY_kbit_s);
  }
  put_packed(w, SAY_colon);
  put_message(w, CATALOGUE_CAN, (uint16_t)now.bus.state);
}

static void line_errors(octet_writer_t* w) {
  put_packed(w, SAY_errors);
  put_count(w, now.bus.transmit_errors, SAY_sending);
  put_count(w, now.bus.receive_errors, SAY_receiving);
  put_count(w, now.bus.bus_offs, SAY_times_restarted);
  put_count(w, now.bus.restarts, SAY_times);
}

static void line_lost(octet_writer_t* w) {
  put_packed(w, SAY_lost);
  put_count(w, now.lost, SAY_frames_or_records);
  put_count(w, now.bad_commands, SAY_commands_rejected);
}

static void line_command(octet_writer_t* w) {
  packed_text_t how = SAY_none_received;
  if (now.heard) how = SAY_received_but_not_started;
  if (now.commanding) how = SAY_in_command_of_the_drive;
  if (now.timed_out) how = SAY_missing_can_timeout;
  put_packed(w, SAY_commands);
  put_packed(w, how);
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

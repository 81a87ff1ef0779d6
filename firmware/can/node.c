#include "firmware/can/node.h"

#include <stddef.h>

#include "firmware/api/actions.h"
#include "firmware/api/status.h"
#include "firmware/can/command.h"
#include "firmware/can/messages.h"
#include "firmware/can/segments.h"
#include "firmware/can/telemetry.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/link/stream.h"
#include "firmware/mode/mode.h"
#include "hal/hal_profile.h"

#define DIAGNOSTIC_PERIOD_MS 1000
#define STANDARD_MASK 0x7FFuL

// Receive groups, and how many frames of each may wait for the background level.
enum { GROUP_COMMAND, GROUP_PARAMETER, GROUP_RECORD, GROUPS };
#define COMMAND_MAILBOXES 2u
#define PARAMETER_MAILBOXES 2u
#define RECORD_MAILBOXES 12u

// Which overtakes which in the controller. Records leave mailboxes for the others.
#define PRIORITY_STATUS 3u
#define PRIORITY_PARAMETER 2u
#define PRIORITY_TELEMETRY 1u
#define PRIORITY_RECORD 0u
#define RECORDS_WAITING_MAX 8u
#define RECORD_FRAMES_PER_ROUND 4u

// Estimates, as those of isr_cycles.h.
#define CYCLES_ROUND 60u
#define CYCLES_MESSAGE 600u  // fields of a whole message, CRC
#define CYCLES_PIECE 150u

typedef enum { PARAMETER_GET = 0, PARAMETER_SET = 1 } parameter_operation_t;

static struct {
  can_answer_t answer;
  uint16_t node;
  uint16_t status_alive;
  bool request_ready;
  bool bus_off;
  int32_t rate_kbit;                                // in use; -1: not set up yet
  uint32_t status_ms, telemetry_ms, diagnostic_ms;  // last sent
  uint32_t bus_off_ms;
  can_command_t command;
  segment_joiner_t request;
  segment_splitter_t response;
} self;

void can_node_reset(can_answer_t answer) {
  self.answer = answer;
  self.rate_kbit = -1;
  can_command_reset(&self.command);
  segment_join_reset(&self.request);
  self.request_ready = false;
  self.response.count = 0u;
  self.status_alive = 0u;
  self.status_ms = self.telemetry_ms = self.diagnostic_ms = drive.time_ms;
  self.bus_off = false;
}

// ---- bus ---------------------------------------------------------------------------------------------------

static hal_can_group_t group_of(uint16_t base, uint16_t mailboxes) {
  hal_can_group_t group;
  group.id = base + self.node;
  group.mask = STANDARD_MASK;
  group.extended = false;
  group.mailboxes = mailboxes;
  return group;
}

static void follow_parameters(void) {
  if (parameters.can_rate == self.rate_kbit && parameters.can_node == (int32_t)self.node) return;
  self.rate_kbit = parameters.can_rate;
  self.node = (uint16_t)parameters.can_node;
  hal_can_group_t groups[GROUPS];
  groups[GROUP_COMMAND] = group_of(CAN_COMMAND_BASE, COMMAND_MAILBOXES);
  groups[GROUP_PARAMETER] = group_of(CAN_PARAMETER_REQUEST_BASE, PARAMETER_MAILBOXES);
  groups[GROUP_RECORD] = group_of(CAN_RECORD_REQUEST_BASE, RECORD_MAILBOXES);
  (void)hal_can_init((uint32_t)self.rate_kbit * 1000uL, groups, (uint16_t)GROUPS);
}

static void watch_bus(uint32_t now_ms) {
  const bool bus_off = hal_can_status().state == HAL_CAN_BUS_OFF;
  if (!bus_off || !self.bus_off) self.bus_off_ms = now_ms;
  self.bus_off = bus_off;
  if (!bus_off || now_ms - self.bus_off_ms < (uint32_t)parameters.can_recovery) return;
  self.bus_off_ms = now_ms;
  hal_can_recover();
}

// ---- periodic messages -------------------------------------------------------------------------------------

static bool is_due(uint32_t* last_ms, int32_t period_ms, uint32_t now_ms) {
  if (period_ms == 0 || now_ms - *last_ms < (uint32_t)period_ms) return false;
  *last_ms = now_ms;
  return true;
}

static void send_status(void) {
  hal_can_frame_t frame = can_frame(CAN_STATUS, self.node);
  self.status_alive = (uint16_t)(self.status_alive + 1u);
  telemetry_status(&frame, &self.command, self.status_alive & 0xFu);
  hal_profile_step(CYCLES_MESSAGE);
  (void)hal_can_send(&frame, PRIORITY_STATUS);
}

static void send_telemetry(void) {
  hal_can_frame_t first = can_frame(CAN_TELEMETRY_1, self.node);
  hal_can_frame_t second = can_frame(CAN_TELEMETRY_2, self.node);
  telemetry_values(&first, &second);
  hal_profile_step(2u * CYCLES_MESSAGE);
  if (hal_can_send(&first, PRIORITY_TELEMETRY)) (void)hal_can_send(&second, PRIORITY_TELEMETRY);
}

can_node_state_t can_node_state(void) {
  can_node_state_t state;
  state.node = self.node;
  state.rate_kbit = self.rate_kbit;
  state.heard = self.command.heard;
  state.commanding = self.command.commanding;
  state.timed_out = self.command.timed_out;
  state.bus = hal_can_status();
  state.bad_commands = self.command.bad;
  const uint32_t lost = (uint32_t)state.bus.lost + self.command.gaps + self.request.dropped;
  state.lost = lost > 0xFFFFuL ? 0xFFFFu : (uint16_t)lost;
  return state;
}

static void send_diagnostic(void) {
  const can_node_state_t errors = can_node_state();
  hal_can_frame_t frame = can_frame(CAN_DIAGNOSTIC, self.node);
  const int32_t counts[] = {errors.bad_commands,        errors.lost,
                            errors.bus.bus_offs,        errors.bus.restarts,
                            errors.bus.transmit_errors, errors.bus.receive_errors};
  can_put_all(&frame, CAN_DIAGNOSTIC_BAD_COMMANDS, counts, sizeof counts / sizeof counts[0]);
  hal_profile_step(CYCLES_MESSAGE);
  (void)hal_can_send(&frame, PRIORITY_TELEMETRY);
}

// One of them a round: the shortest period first.
static void send_periodic(uint32_t now_ms) {
  if (hal_can_waiting(PRIORITY_STATUS) == 0u && is_due(&self.status_ms, parameters.can_status_period, now_ms)) {
    send_status();
  } else if (hal_can_waiting(PRIORITY_TELEMETRY) == 0u) {
    if (is_due(&self.telemetry_ms, parameters.can_telemetry_period, now_ms)) {
      send_telemetry();
    } else if (is_due(&self.diagnostic_ms, DIAGNOSTIC_PERIOD_MS, now_ms)) {
      send_diagnostic();
    }
  }
}

// ---- parameters --------------------------------------------------------------------------------------------

// The reason in words does not fit into a message; a record has it.
static answer_status_t carry_out(int32_t operation, uint16_t id, int32_t raw) {
  const parameter_info_t* const parameter = parameter_by_id(id);
  octet_writer_t unheard = octet_writer(NULL, 0u);
  if (parameter == NULL) return parameter_is_left_out(id) ? ANSWER_EDITION : ANSWER_UNKNOWN;
  if (operation == PARAMETER_GET) return ANSWER_OK;
  return operation == PARAMETER_SET ? action_set(parameter, raw, &unheard) : ANSWER_RANGE;
}

static void answer_parameter(void) {
  hal_can_frame_t request;
  if (hal_can_waiting(PRIORITY_PARAMETER) != 0u || !hal_can_receive(GROUP_PARAMETER, &request)) return;
  if (request.length != (uint16_t)CAN_PARAMETER_REQUEST_OCTETS) return;
  const int32_t operation = can_get(&request, CAN_PARAMETER_REQUEST_OPERATION);
  const uint16_t id = (uint16_t)can_get(&request, CAN_PARAMETER_REQUEST_ID);
  const answer_status_t result = carry_out(operation, id, can_get(&request, CAN_PARAMETER_REQUEST_RAW));
  hal_can_frame_t response = can_frame(CAN_PARAMETER_RESPONSE, self.node);
  const int32_t answers[] = {operation, id, parameter_get(id), (int32_t)result};
  can_put_all(&response, CAN_PARAMETER_RESPONSE_OPERATION, answers, sizeof answers / sizeof answers[0]);
  hal_profile_step(2u * CYCLES_MESSAGE);
  (void)hal_can_send(&response, PRIORITY_PARAMETER);
}

// ---- records -----------------------------------------------------------------------------------------------

static void read_record(uint32_t now_ms) {
  hal_can_frame_t frame;
  for (uint16_t k = 0u; k < RECORD_FRAMES_PER_ROUND && !self.request_ready; k++) {
    if (!hal_can_receive(GROUP_RECORD, &frame)) break;
    self.request_ready = segment_join(&self.request, &frame, now_ms);
    hal_profile_step(CYCLES_PIECE);
  }
  segment_join_rest(&self.request, now_ms);
}

// One request at a time: the next waits until the answer before it is out.
static void answer_record(uint32_t now_ms) {
  if (!self.request_ready || self.response.count != 0u) return;
  self.request_ready = false;
  if (self.answer == NULL) return;
  const uint16_t count = self.answer(self.request.octets, self.request.count, self.response.octets);
  if (count != 0u) segment_split_begin(&self.response, count, now_ms);
}

// Behind every answer, and only when what was sent before has left: a stream too fast for the bus leaves room for all
// else.
static void send_event(uint32_t now_ms) {
  if (self.response.count != 0u || hal_can_waiting(PRIORITY_RECORD) != 0u) return;
  const uint16_t count = stream_event(COMM_WATCHDOG_BUS, self.response.octets);
  if (count != 0u) segment_split_begin(&self.response, count, now_ms);
}

static void write_record(uint32_t now_ms) {
  hal_can_frame_t frame = can_frame(CAN_RECORD_RESPONSE, self.node);
  for (uint16_t k = 0u; k < RECORD_FRAMES_PER_ROUND; k++) {
    if (!segment_split_peek(&self.response, &frame)) return;
    if (hal_can_waiting(PRIORITY_RECORD) >= RECORDS_WAITING_MAX || !hal_can_send(&frame, PRIORITY_RECORD)) break;
    segment_split_advance(&self.response, now_ms);
    hal_profile_step(CYCLES_PIECE);
  }
  // Nobody takes it: what is left of the answer would be old when somebody does.
  if (self.response.count != 0u && now_ms - self.response.last_ms > SEGMENTS_REST_MS) {
    if (self.response.octets[0] == EVENT_STREAM) stream_dropped(COMM_WATCHDOG_BUS);
    self.response.count = 0u;
    hal_can_cancel(PRIORITY_RECORD);
  }
}

void can_node_service(void) {
  const uint32_t now_ms = drive.time_ms;
  hal_can_frame_t frame;
  hal_profile_step(CYCLES_ROUND);
  // With the host in the loop the drive and its parameters are a simulation's: the bus carries records and knows
  // nothing of the rest.
  const bool own_drive = !feature_status.stepped;
  if (feature_status.loading) return;
  if (own_drive) follow_parameters();
  hal_can_service();
  watch_bus(now_ms);
  const bool commanded = hal_can_receive(GROUP_COMMAND, &frame);
  if (own_drive) {
    if (commanded) can_command_take(&self.command, &frame, now_ms);
    if (commanded) hal_profile_step(CYCLES_MESSAGE);
    can_command_service(&self.command, now_ms);
  }
  answer_parameter();
  read_record(now_ms);
  answer_record(now_ms);
  send_event(now_ms);
  write_record(now_ms);
  if (own_drive) send_periodic(now_ms);
}

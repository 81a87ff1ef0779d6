// The node of the bus with any frames, any parameters of its own, any state of bus and drive, round after round without
// end. Records that it carries are framing.c's and requests.c's.

#include "firmware/can/node.h"

#include "firmware/api/status.h"
#include "firmware/can/command.h"
#include "firmware/can/messages.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/link/record.h"
#include "firmware/link/stream.h"
#include "tests/prove/any_drive.h"

uint16_t hal_sci_room(void) { return any_u16; }

bool hal_can_init(uint32_t bitrate, const hal_can_group_t* groups, uint16_t count) {
  (void)bitrate;
  for (uint16_t k = 0; k < count; k++) any_u32 = groups[k].id;
  return any_bool();
}
void hal_can_service(void) {}
void hal_can_cancel(uint16_t priority) { (void)priority; }
void hal_can_recover(void) {}
bool hal_can_send(const hal_can_frame_t* frame, uint16_t priority) {
  (void)priority;
  for (uint16_t k = 0; k < frame->length; k++) any_u16 = frame->data[k];
  return any_bool();
}
uint16_t hal_can_waiting(uint16_t priority) {
  (void)priority;
  return any_up_to(HAL_CAN_MAILBOXES);
}
bool hal_can_receive(uint16_t group, hal_can_frame_t* frame) {
  (void)group;
  if (any_bool()) return false;
  frame->id = any_u32;
  frame->extended = any_bool();
  frame->length = any_up_to(8);
  any_octets(frame->data, 8);
  return true;
}
hal_can_status_t hal_can_status(void) {
  hal_can_status_t s;
  s.state = (hal_can_state_t)any_up_to(5);
  s.transmit_errors = any_u16;
  s.receive_errors = any_u16;
  s.lost = any_u16;
  s.bus_offs = any_u16;
  s.restarts = any_u16;
  return s;
}

static uint16_t any_answer(const uint16_t* request, uint16_t count, uint16_t* answer) {
  for (uint16_t k = 0; k < count; k++) any_u16 = request[k];
  any_octets(answer, RECORD_MAX);
  return any_up_to(RECORD_MAX - 2u);
}

// Within the table's ranges: the part parameters has it that they stay there.
static void any_parameters(void) {
  parameters.can_node = any_from(1, (int32_t)CAN_NODE_MAX);
  parameters.can_rate = any_from(0, 1000);
  parameters.can_timeout = any_from(10, 10000);
  parameters.can_reaction = any_from(0, 2);
  parameters.can_status_period = any_from(0, 10000);
  parameters.can_telemetry_period = any_from(0, 10000);
  parameters.can_recovery = any_from(1, 10000);
}

// Every field of every message, whatever stands in it.
static void fields(void) {
  hal_can_frame_t frame = can_frame(CAN_STATUS, any_u16);
  //@ loop unroll 100;
  for (uint16_t f = 0; can_field_info(f) != 0; f++) {
    any_octets(frame.data, 8);
    (void)can_get(&frame, (can_field_t)f);
    can_put(&frame, (can_field_t)f, any_i32);
    //@ loop unroll 24;
    for (uint16_t q = 1; q <= 24u; q++) (void)can_steps((can_field_t)f, any_i32, q);
  }
}

void prove_node(void) {
  fields();
  parameters_reset(&parameters);
  can_node_reset(any_bool() ? any_answer : 0);
  stream_reset();
  while (any_bool()) {
    any_moment();
    any_parameters();
    feature_status.stepped = any_bool();
    if (any_bool()) any_stream(COMM_WATCHDOG_BUS);
    can_node_service();
    (void)can_node_state();
  }
}

// The drive as a node of the CAN bus: command, status, telemetry, parameters by number, records of the link.
//
// can_node_service is called in every round of the background loop: a few frames, and it returns. Nothing waits for the
// bus, which carries the stream of whoever asked for it here, too. A periodic message whose predecessor has not left
// yet is left out. After bus-off the node is silent for can_recovery and then tries again. A changed rate or node
// number takes effect at once.

#ifndef STILLSPIN_FIRMWARE_CAN_NODE_H
#define STILLSPIN_FIRMWARE_CAN_NODE_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/hal_can.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Answers `count` octets of a record's type, tag and body. Returns the number of octets of the answer, for which there
/// is room of RECORD_MAX - 2; 0 for none.
typedef uint16_t (*can_answer_t)(const uint16_t* request, uint16_t count, uint16_t* answer);

/// Power-on state, off the bus until the saved rate and number are known (feature_status.loading): at another rate than
/// the bus' a node disturbs all others. `answer` may be NULL: no records then.
void can_node_reset(can_answer_t answer);
/// The same, with the answers of the serial port (power_on.c).
void can_power_on(void);

/// Background level.
void can_node_service(void);

/// How it is, and what went wrong since power-on; counts stay at 65535.
typedef struct {
  uint16_t node;
  int32_t rate_kbit;                  // in use; -1 before the saved one is known
  bool heard, commanding, timed_out;  // of COMMAND: see command.h
  hal_can_status_t bus;
  uint16_t bad_commands;
  uint16_t lost;  // frames and records that did not arrive whole
} can_node_state_t;

can_node_state_t can_node_state(void);

#if defined(__cplusplus)
}
#endif

#endif

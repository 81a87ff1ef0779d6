// The COMMAND message: who may move the drive from the bus, and what happens when he falls silent.
//
// A command counts when its length and CRC are right and its alive counter has moved on. Mode RUN starts the drive once
// for each change to RUN from another mode, when the drive is READY: neither power-on nor a cleared fault nor commands
// that come back after a time-out start it. From then on the drive is under the bus' command: speed, stop and off act
// on it with every message, and when no command counts for can_timeout, can_reaction follows. A drive that somebody
// else has started is left alone, but a change to mode OFF or STOP acts on it all the same.

#ifndef STILLSPIN_FIRMWARE_CAN_COMMAND_H
#define STILLSPIN_FIRMWARE_CAN_COMMAND_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/hal_can.h"

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum { CAN_MODE_OFF = 0, CAN_MODE_STOP = 1, CAN_MODE_RUN = 2 } can_mode_t;

/// Values of the parameter can_reaction.
typedef enum { CAN_REACTION_NONE = 0, CAN_REACTION_STOP = 1, CAN_REACTION_COAST = 2 } can_reaction_t;

typedef struct {
  bool heard;        // a command has counted since power-on
  uint16_t alive;    // of the last one
  int32_t mode;      // of the last one
  bool clear_fault;  // of the last one
  bool armed;        // the next RUN starts
  bool commanding;   // the drive was started by the bus
  bool timed_out;    // until a command counts again
  uint32_t heard_ms;
  uint16_t bad;   // commands that did not count; stays at 65535, like the next
  uint16_t gaps;  // commands that never came, by the alive counter
} can_command_t;

void can_command_reset(can_command_t* c);

/// Takes a frame with the identifier of COMMAND.
void can_command_take(can_command_t* c, const hal_can_frame_t* frame, uint32_t now_ms);

/// Background level: the time-out.
void can_command_service(can_command_t* c, uint32_t now_ms);

#if defined(__cplusplus)
}
#endif

#endif

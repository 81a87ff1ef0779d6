// The CAN controller: receive groups, transmit mailboxes, error states. All calls are for the background level; none
// waits.
//
// Frames of a group are given out in the order in which they came. The last mailbox of a group may be overwritten when
// the group is full, which is counted; the older frames are kept. Frames of one priority are sent in the order in which
// they were given; a higher priority overtakes. A frame stays in its mailbox until it has been acknowledged by another
// node, so on a bus without anybody else the mailboxes fill up and hal_can_send says no.
//
// After bus-off the controller is silent until hal_can_recover. A controller that has stopped to send without an error
// (an erratum of the chip) is restarted, which costs frames that arrive within some 20 us.

#ifndef STILLSPIN_HAL_HAL_CAN_H
#define STILLSPIN_HAL_HAL_CAN_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_CAN_MAILBOXES 32u
#define HAL_CAN_GROUPS_MAX 6u
#define HAL_CAN_PRIORITIES 4u  // 0 the lowest .. 3

typedef struct {
  uint32_t id;  // 11 or 29 bits
  bool extended;
  uint16_t length;   // octets, 0..8
  uint16_t data[8];  // one octet a word
} hal_can_frame_t;

// Frames whose identifier agrees with `id` in the bits that are set in `mask`.
typedef struct {
  uint32_t id;
  uint32_t mask;
  bool extended;
  uint16_t mailboxes;
} hal_can_group_t;

typedef enum {
  HAL_CAN_OFF = 0,       // not initialised, or a bit rate that cannot be made
  HAL_CAN_STARTING = 1,  // waits for the bus
  HAL_CAN_ACTIVE = 2,
  HAL_CAN_WARNING = 3,  // an error counter is at 96 or more
  HAL_CAN_PASSIVE = 4,  // 128 or more: nobody acknowledges, or many errors
  HAL_CAN_BUS_OFF = 5
} hal_can_state_t;

typedef struct {
  hal_can_state_t state;
  uint16_t transmit_errors, receive_errors;  // the controller's counters, 0..255
  uint16_t lost;                             // received frames that were overwritten; saturating, like the rest
  uint16_t bus_offs;
  uint16_t restarts;  // transmission had stopped without an error
} hal_can_status_t;

// Begins to configure the controller; goes on in hal_can_service. bitrate: bits/s, 10000 to 1000000, at which 100 MHz
// give 8 to 20 time quanta. At least one mailbox has to be left for transmission. May be called again at any time.
// False: the rate or the groups are impossible, and the controller is off.
bool hal_can_init(uint32_t bitrate, const hal_can_group_t* groups, uint16_t count);

// Takes the controller off the bus for good.
void hal_can_off(void);

// Once per background loop: carries the configuration on, looks at the error state and at mailboxes that do not empty.
void hal_can_service(void);

// The oldest frame of a group (0..count - 1 of hal_can_init); false when there is none. Remote frames are dropped.
bool hal_can_receive(uint16_t group, hal_can_frame_t* frame);

// Hands a frame to a mailbox. False: no mailbox is free, or the controller is not on the bus.
bool hal_can_send(const hal_can_frame_t* frame, uint16_t priority);

// Takes back what waits with this priority; a frame that is on the wire may still go.
void hal_can_cancel(uint16_t priority);

// Frames of this priority that have not been acknowledged yet.
uint16_t hal_can_waiting(uint16_t priority);

hal_can_status_t hal_can_status(void);

// Leaves bus-off: back on the bus after 128 times 11 recessive bits. Does nothing otherwise.
void hal_can_recover(void);

#ifdef __cplusplus
}
#endif

#endif

// Messages of the bus as numbers in frames, by the table in message_list.h.
//
// A field is a place of some bits in up to eight octets, held one in a word. Values are whole steps of the field; what
// does not fit is clamped to the nearest that does, and a field with more than 16 bits takes what an int32_t holds.

#ifndef STILLSPIN_FIRMWARE_CAN_MESSAGES_H
#define STILLSPIN_FIRMWARE_CAN_MESSAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/hal_can.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define CAN_NODE_MAX 31u

#define CAN_MESSAGE(message, base, octets, sender, meaning) CAN_##message,
#define CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning)
typedef enum {
#include "firmware/can/message_list.h"
  CAN_MESSAGES
} can_message_t;
#undef CAN_MESSAGE
#undef CAN_FIELD

/// Of node 0, and how long they are.
#define CAN_MESSAGE(message, base, octets, sender, meaning) \
  CAN_##message##_BASE = base, CAN_##message##_OCTETS = octets,
#define CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning)
enum {
#include "firmware/can/message_list.h"
  CAN_BASE_NONE = 0
};
#undef CAN_MESSAGE
#undef CAN_FIELD

#define CAN_MESSAGE(message, base, octets, sender, meaning)
#define CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning) CAN_##message##_##field,
typedef enum {
#include "firmware/can/message_list.h"
  CAN_FIELDS
} can_field_t;
#undef CAN_MESSAGE
#undef CAN_FIELD

// What the drive needs of the table; names, senders, units and meanings are for the other end.
typedef struct {
  uint16_t base : 12, octets : 4;
} can_message_info_t;

typedef struct {
  uint16_t message : 4;  // can_message_t
  uint16_t first : 6, bits : 6;
  uint16_t is_signed : 1, per_unit : 15;
} can_field_info_t;

extern const can_message_info_t can_message_infos[];
extern const can_field_info_t can_field_infos[];

/// NULL behind the last one.
static inline const can_message_info_t* can_message_info(uint16_t message) {
  return message < (uint16_t)CAN_MESSAGES ? &can_message_infos[message] : NULL;
}
static inline const can_field_info_t* can_field_info(uint16_t field) {
  return field < (uint16_t)CAN_FIELDS ? &can_field_infos[field] : NULL;
}

/// An empty message of a node (1..31): identifier, length, zeros.
hal_can_frame_t can_frame(can_message_t message, uint16_t node);

/// Writes a field of the frame's message.
void can_put(hal_can_frame_t* frame, can_field_t field, int32_t value);
/// Fields one behind the other, from this one on.
void can_put_all(hal_can_frame_t* frame, can_field_t first, const int32_t* values, uint16_t count);
int32_t can_get(const hal_can_frame_t* frame, can_field_t field);

/// Steps of the field that a value with q fractional bits (1..24) is, to the nearest.
int32_t can_steps(can_field_t field, int32_t value, uint16_t q);

/// CRC-8 SAE J1850 (polynomial 0x1D, begins with 0xFF, inverted at the end, "123456789" gives 0x4B) over the
/// identifier, low octet first, and the first `count` octets of data: a frame with another's identifier does not pass.
uint16_t can_crc8(const hal_can_frame_t* frame, uint16_t count);

#if defined(__cplusplus)
}
#endif

#endif

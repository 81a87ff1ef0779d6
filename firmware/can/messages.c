#include "firmware/can/messages.h"

#include "hal/qmath/qarith.h"
#include "hal/qmath/qcall.h"

#define UNSIGNED 0
#define SIGNED 1

#define CAN_MESSAGE(message, base, octets, sender, meaning) {base, octets},
#define CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning)
const can_message_info_t can_message_infos[] = {
#include "firmware/can/message_list.h"
};
#undef CAN_MESSAGE
#undef CAN_FIELD

#define CAN_MESSAGE(message, base, octets, sender, meaning)
#define CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning) \
  {CAN_##message, first, bits, sign, per_unit},
const can_field_info_t can_field_infos[] = {
#include "firmware/can/message_list.h"
};
#undef CAN_MESSAGE
#undef CAN_FIELD

hal_can_frame_t can_frame(can_message_t message, uint16_t node) {
  hal_can_frame_t frame = {0uL, false, 0u, {0u}};
  frame.id = (uint16_t)(can_message_infos[message].base + node);
  frame.length = can_message_infos[message].octets;
  return frame;
}

static int32_t clamp_to(const can_field_info_t* f, int32_t value) {
  if (f->bits >= 32u) return value;
  const int32_t span = (int32_t)((uint32_t)1u << (f->bits - f->is_signed));
  return q_clamp(value, (f->is_signed != 0u) ? -span : 0, span - 1);
}

void can_put(hal_can_frame_t* frame, can_field_t field, int32_t value) {
  const can_field_info_t* const f = &can_field_infos[field];
  const uint32_t steps = (uint32_t)clamp_to(f, value);
  for (uint16_t k = 0u; k < f->bits; k++) {
    const uint16_t at = (uint16_t)(f->first + k);
    const uint16_t bit = (uint16_t)(1u << (at & 7u));
    uint16_t* const octet = &frame->data[at >> 3];
    *octet = (uint16_t)((*octet & (uint16_t)~bit) | ((steps >> k & 1uL) != 0uL ? bit : 0u));
  }
}

void can_put_all(hal_can_frame_t* frame, can_field_t first, const int32_t* values, uint16_t count) {
  for (uint16_t k = 0u; k < count; k++) can_put(frame, (can_field_t)((uint16_t)first + k), values[k]);
}

int32_t can_get(const hal_can_frame_t* frame, can_field_t field) {
  const can_field_info_t* const f = &can_field_infos[field];
  uint32_t steps = 0uL;
  for (uint16_t k = 0u; k < f->bits; k++) {
    const uint16_t at = (uint16_t)(f->first + k);
    steps |= (uint32_t)(frame->data[at >> 3] >> (at & 7u) & 1u) << k;
  }
  const uint16_t above = (uint16_t)(32u - f->bits);
  return (f->is_signed != 0u) ? q_shr((int32_t)(steps << above), above) : (int32_t)steps;
}

int32_t can_steps(can_field_t field, int32_t value, uint16_t q) {
  return qc_mul_sat(value, (int32_t)can_field_infos[field].per_unit, q);
}

static uint16_t crc8_add(uint16_t crc, uint16_t octet) {
  crc = (uint16_t)((crc ^ octet) & 0xFFu);
  for (uint16_t k = 0u; k < 8u; k++) crc = (uint16_t)((crc << 1 ^ ((crc & 0x80u) != 0u ? 0x1Du : 0u)) & 0xFFu);
  return crc;
}

uint16_t can_crc8(const hal_can_frame_t* frame, uint16_t count) {
  uint16_t crc = crc8_add(0xFFu, (uint16_t)(frame->id & 0xFFu));
  crc = crc8_add(crc, (uint16_t)(frame->id >> 8 & 0xFFu));
  for (uint16_t k = 0u; k < count; k++) crc = crc8_add(crc, frame->data[k]);
  return (uint16_t)(crc ^ 0xFFu);
}

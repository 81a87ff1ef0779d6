// What lies between the wire and a request or a line: any octets and any frames, at any times, and any record on its
// way out. Where the pieces are told apart by what came before, one step is made from every state that there can be,
// and has to lead to such a state again (link_ranges.h): so it holds step after step without end.

#include "firmware/base/crc.h"
#include "firmware/can/segments.h"
#include "firmware/link/cobs.h"
#include "firmware/link/splitter.h"
#include "tests/prove/any.h"

static uint16_t octets[RECORD_ENCODED_MAX];
static uint16_t wire[RECORD_ENCODED_MAX + 2u];

static void any_octets(uint16_t* to, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) to[k] = any_u16;
}

// Each octet of a block by itself: so it is known how many there can have been.
void prove_blocks(void) {
  any_octets(octets, RECORD_ENCODED_MAX);
  (void)cobs_decode(octets, any_up_to(RECORD_ENCODED_MAX));
  any_octets(octets, RECORD_ENCODED_MAX);
  (void)cobs_encode(octets, any_up_to(RECORD_MAX), wire);
  (void)crc16(octets, any_up_to(RECORD_ENCODED_MAX));
  (void)crc32_add(any_u32, any_u16);
}

static void octet_from_the_wire(bool in_record, bool skipping, uint16_t most) {
  static splitter_t s;
  any_octets(s.octets, RECORD_ENCODED_MAX + 1u);
  s.count = any_up_to(most);
  s.in_record = in_record;
  s.skipping = skipping;
  s.last_ms = any_u32;
  s.errors.damaged = any_u16;
  s.errors.too_long = any_u16;
  s.errors.broken_off = any_u16;
  if (any_bool()) {
    (void)splitter_rest(&s, any_u32);
  } else {
    (void)splitter_octet(&s, any_u16, any_u32);
  }
}

static hal_can_frame_t any_frame(void) {
  hal_can_frame_t frame;
  frame.id = any_u32;
  frame.extended = any_bool();
  frame.length = any_up_to(8);
  any_octets(frame.data, 8);
  return frame;
}

static void from_the_bus(void) {
  static segment_joiner_t j;
  const hal_can_frame_t frame = any_frame();
  segment_join_reset(&j);
  any_octets(j.octets, RECORD_MAX);
  j.count = any_up_to(RECORD_MAX);
  j.next = any_up_to(SEGMENT_NUMBER);
  j.open = any_bool();
  j.dropped = any_u16;
  (void)segment_join(&j, &frame, any_u32);
  segment_join_rest(&j, any_u32);
}

// A piece that is the last one of `count` octets, or one of many.
static void piece_to_the_bus(uint16_t number, bool last) {
  static segment_splitter_t s;
  hal_can_frame_t frame = any_frame();
  any_octets(s.octets, RECORD_MAX);
  s.at = (uint16_t)(number * SEGMENT_OCTETS);
  s.count = last ? (uint16_t)(s.at + any_up_to(SEGMENT_OCTETS)) : (uint16_t)any_from(s.at + 8, (int32_t)RECORD_MAX);
  if (s.count > RECORD_MAX) return;
  s.number = any_up_to(SEGMENT_NUMBER);
  s.last_ms = any_u32;
  if (!segment_split_peek(&s, &frame)) return;
  segment_split_advance(&s, any_u32);
  //@ assert s.count == 0 || s.at == 7 * number + 7;
}

void prove_framing(void) {
  octet_from_the_wire(false, false, RECORD_ENCODED_MAX + 1u);
  octet_from_the_wire(false, true, RECORD_ENCODED_MAX + 1u);
  octet_from_the_wire(true, false, RECORD_ENCODED_MAX);
  octet_from_the_wire(true, true, RECORD_ENCODED_MAX + 1u);
  any_octets(octets, RECORD_MAX);
  (void)record_to_wire(octets, (uint16_t)any_from(1, (int32_t)RECORD_MAX - 2), wire);
  from_the_bus();
  for (uint16_t number = 0; number <= RECORD_MAX / SEGMENT_OCTETS; number++) {
    piece_to_the_bus(number, false);
    piece_to_the_bus(number, true);
  }
}

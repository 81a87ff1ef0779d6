#include "firmware/can/segments.h"

void segment_join_reset(segment_joiner_t* j) {
  j->count = 0u;
  j->next = 0u;
  j->open = false;
  j->dropped = 0u;
  j->last_ms = 0uL;
}

// False, for whoever has a record no more.
static bool drop(segment_joiner_t* j) {
  j->open = false;
  if (j->dropped < 0xFFFFu) j->dropped++;
  return false;
}

static bool take(segment_joiner_t* j, const hal_can_frame_t* frame) {
  for (uint16_t k = 1u; k < frame->length; k++) {
    if (j->count >= RECORD_MAX) return drop(j);
    j->octets[j->count++] = frame->data[k] & 0xFFu;
  }
  j->next = (uint16_t)((j->next + 1u) & SEGMENT_NUMBER);
  return true;
}

bool segment_join(segment_joiner_t* j, const hal_can_frame_t* frame, uint32_t now_ms) {
  if (frame->length == 0u) return false;
  const uint16_t head = frame->data[0];
  j->last_ms = now_ms;
  if ((head & SEGMENT_FIRST) != 0u) {
    if (j->open) (void)drop(j);
    j->open = true;
    j->count = 0u;
    j->next = 0u;
  }
  if (!j->open) return false;
  if ((head & SEGMENT_NUMBER) != j->next) return drop(j);
  if (!take(j, frame) || (head & SEGMENT_LAST) == 0u) return false;
  const uint16_t count = record_open(j->octets, j->count);
  if (count == 0u) return drop(j);
  j->open = false;
  j->count = count;
  return true;
}

void segment_join_rest(segment_joiner_t* j, uint32_t now_ms) {
  if (j->open && now_ms - j->last_ms > SEGMENTS_REST_MS) (void)drop(j);
}

void segment_split_begin(segment_splitter_t* s, uint16_t count, uint32_t now_ms) {
  s->count = record_seal(s->octets, count);
  s->at = 0u;
  s->number = 0u;
  s->last_ms = now_ms;
}

bool segment_split_peek(const segment_splitter_t* s, hal_can_frame_t* frame) {
  if (s->at >= s->count) return false;
  const uint16_t left = (uint16_t)(s->count - s->at);
  const uint16_t piece = left < SEGMENT_OCTETS ? left : SEGMENT_OCTETS;
  frame->data[0] = (uint16_t)(s->number | (s->at == 0u ? SEGMENT_FIRST : 0u) | (piece == left ? SEGMENT_LAST : 0u));
  for (uint16_t k = 0u; k < piece; k++) frame->data[k + 1u] = s->octets[s->at + k];
  frame->length = (uint16_t)(piece + 1u);
  return true;
}

void segment_split_advance(segment_splitter_t* s, uint32_t now_ms) {
  s->at = (uint16_t)(s->at + SEGMENT_OCTETS);
  s->number = (uint16_t)((s->number + 1u) & SEGMENT_NUMBER);
  s->last_ms = now_ms;
  if (s->at >= s->count) s->count = 0u;
}

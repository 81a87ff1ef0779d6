// Records of the link (firmware/link/record.h) in pieces of seven octets, as frames of the bus carry them.
//
// The first octet of a frame: bit 7 in the first piece, bit 6 in the last, and the number of the piece modulo 64. The
// record has its CRC-16. A piece that is missing or out of order drops the record, counted; the next first piece begins
// anew. So does a record that is not complete after SEGMENTS_REST_MS without a piece.

#ifndef STILLSPIN_FIRMWARE_CAN_SEGMENTS_H
#define STILLSPIN_FIRMWARE_CAN_SEGMENTS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/link/record.h"
#include "hal/hal_can.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define SEGMENT_OCTETS 7u
#define SEGMENT_FIRST 0x80u
#define SEGMENT_LAST 0x40u
#define SEGMENT_NUMBER 0x3Fu
#define SEGMENTS_REST_MS 500u

/// What comes.
typedef struct {
  uint16_t count;
  uint16_t next;  // number of the next piece
  bool open;      // between a first and a last piece
  uint32_t last_ms;
  uint16_t dropped;  // records; stays at 65535
  uint16_t octets[RECORD_MAX];
} segment_joiner_t;

/// What goes.
typedef struct {
  uint16_t count;  // 0: nothing is on its way
  uint16_t at;
  uint16_t number;
  uint32_t last_ms;  // when a piece was last taken by a mailbox
  uint16_t octets[RECORD_MAX];
} segment_splitter_t;

void segment_join_reset(segment_joiner_t* j);

/// Takes a frame. True when it completes a record with a right CRC: octets[0..count) without it, until the next call.
bool segment_join(segment_joiner_t* j, const hal_can_frame_t* frame, uint32_t now_ms);

/// Now and then while nothing comes.
void segment_join_rest(segment_joiner_t* j, uint32_t now_ms);

/// Begins to send the first `count` octets in s->octets (at most RECORD_MAX - 2), to which the CRC is appended.
void segment_split_begin(segment_splitter_t* s, uint16_t count, uint32_t now_ms);

/// Fills data and length of the next piece without moving on; false when everything has gone.
bool segment_split_peek(const segment_splitter_t* s, hal_can_frame_t* frame);
/// The piece is on its way.
void segment_split_advance(segment_splitter_t* s, uint32_t now_ms);

#if defined(__cplusplus)
}
#endif

#endif

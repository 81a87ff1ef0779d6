// What the pieces of serial port, bus and console need and give, in ACSL: each is read by itself with anything that its
// header admits, and what calls it is read with these lines in its place.

#ifndef STILLSPIN_TESTS_PROVE_LINK_RANGES_H
#define STILLSPIN_TESTS_PROVE_LINK_RANGES_H

#include "firmware/can/segments.h"
#include "firmware/link/splitter.h"
#include "tests/prove/qmath_ranges.h"

/*@ requires count == 0 || \valid_read(octets + (0 .. count - 1)); assigns \result \from octets[0 .. count - 1]; */
uint16_t crc16(const uint16_t* octets, uint16_t count);

/*@ requires count <= 245 && \valid_read(from + (0 .. 244)) && \valid(to + (0 .. 245));
    assigns to[0 .. 245] \from from[0 .. 244]; assigns \result \from count;
    ensures \result <= 246; ensures \initialized(to + (0 .. 245)); */
uint16_t cobs_encode(const uint16_t* from, uint16_t count, uint16_t* to);

/*@ requires count <= 256 && \valid(octets + (0 .. 255));
    assigns octets[0 .. 255], \result \from octets[0 .. 255], count; */
uint16_t cobs_decode(uint16_t* octets, uint16_t count);

/*@ requires \valid(s); assigns *s, \result \from *s, octet, now_ms;
    ensures -1 <= \result <= 257; ensures \result == -1 ==> s->count <= 243;
    ensures s->count <= 257; ensures s->in_record && !s->skipping ==> s->count <= 256; */
int16_t splitter_octet(splitter_t* s, uint16_t octet, uint32_t now_ms);

/*@ requires \valid(s); assigns *s, \result \from *s, now_ms; ensures 0 <= \result <= 257;
    ensures s->count <= 257; ensures s->in_record && !s->skipping ==> s->count <= 256; */
int16_t splitter_rest(splitter_t* s, uint32_t now_ms);

/*@ requires \valid(j) && \valid_read(frame); assigns *j, \result \from *j, *frame, now_ms;
    ensures j->count <= 245; ensures \result == 1 ==> j->count <= 243; */
bool segment_join(segment_joiner_t* j, const hal_can_frame_t* frame, uint32_t now_ms);

#endif

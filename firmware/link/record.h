// A record: what machines say to each other on the link and, in pieces, on the bus.
//
//   request    type 0x01..0x3F   tag      body            CRC-16
//   answer     type | 0x80       tag      status  body    CRC-16
//   event      type 0x40..0x5F   counter  body            CRC-16
//
// The CRC (link/crc.h) goes over all octets before it and comes in little-endian order, as all numbers do. The tag
// comes back with the answer as it was sent. On the serial port a record lies between two octets of zero, without zeros
// of its own (link/cobs.h): 00 COBS(record) 00.

#ifndef STILLSPIN_FIRMWARE_LINK_RECORD_H
#define STILLSPIN_FIRMWARE_LINK_RECORD_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

#define RECORD_BODY_MAX 240u
#define RECORD_MAX (2u + 1u + RECORD_BODY_MAX + 2u)  // with type, tag, status and CRC
#define RECORD_MIN 4u                                // type, tag, CRC
#define RECORD_ENCODED_MAX 256u                      // between the two zeros
#define RECORD_IN_WIRE 2u                            // where a record may lie in the memory of its encoding
#define RECORD_ANSWER 0x80u

/// Appends the CRC to `count` octets, for which there is room. Returns how many there are then.
uint16_t record_seal(uint16_t* octets, uint16_t count);

/// How many octets stand before a right CRC; 0 when it is wrong or the record is too short to be one.
uint16_t record_open(const uint16_t* octets, uint16_t count);

/// Seals and encodes `count` octets of `record` (at most RECORD_MAX - 2) with both zeros around it into `wire`, which
/// has room for RECORD_ENCODED_MAX + 2; `record` is elsewhere or &wire[RECORD_IN_WIRE]. Returns how many octets go on
/// the wire.
uint16_t record_to_wire(uint16_t* record, uint16_t count, uint16_t* wire);

#if defined(__cplusplus)
}
#endif

#endif

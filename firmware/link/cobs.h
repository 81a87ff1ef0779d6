// Consistent overhead byte stuffing: octets 0..255 without their zeros (S. Cheshire, M. Baker, IEEE/ACM Transactions on
// Networking 7(2), 1999). A code octet says how far the next zero was away; 255 that there was none in 254 octets.
//
// Octets are held one in a word. n octets become at least n + 1 and at most n + n / 254 + 1.

#ifndef STILLSPIN_FIRMWARE_LINK_COBS_H
#define STILLSPIN_FIRMWARE_LINK_COBS_H

#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

#define COBS_SIZE(octets) ((octets) + (octets) / 254u + 1u)
#define COBS_MALFORMED 0xFFFFu

/// Encodes `count` octets into `to`, which has room for COBS_SIZE(count) and does not overlap, but that up to 254
/// octets may lie at to + 1, where most of them stay. Returns how many there are; none of them is zero.
uint16_t cobs_encode(const uint16_t* from, uint16_t count, uint16_t* to);

/// Decodes in place. Returns how many octets are left, always fewer than `count`; COBS_MALFORMED for what is no
/// encoding.
uint16_t cobs_decode(uint16_t* octets, uint16_t count);

#if defined(__cplusplus)
}
#endif

#endif

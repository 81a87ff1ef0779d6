// Check sums over octets that are held one in a word; what lies above an octet's eighth bit is not looked at.
//
// CRC-16/CCITT-FALSE (polynomial 0x1021, begins with 0xFFFF, not reflected, "123456789" gives 0x29B1) closes a record
// of the link. CRC-32 of IEEE 802.3 (polynomial 0x04C11DB7 reflected, begins with all ones and is inverted at the end,
// "123456789" gives 0xCBF43926) closes a slot of the store and names the drive's tables.
//
// Both go by half octets, about 20 cycles an octet; CRC-32 has a table of 16 numbers.

#ifndef STILLSPIN_FIRMWARE_BASE_CRC_H
#define STILLSPIN_FIRMWARE_BASE_CRC_H

#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

#define CRC16_BEGIN 0xFFFFu
#define CRC32_BEGIN 0xFFFFFFFFuL

/// The sum so far with one octet more.
uint16_t crc16_add(uint16_t crc, uint16_t octet);
uint32_t crc32_add(uint32_t crc, uint16_t octet);

/// With `count` octets more.
uint32_t crc32_add_all(uint32_t crc, const uint16_t* octets, uint16_t count);

/// What is sent or stored of a CRC-32 that began with CRC32_BEGIN. A CRC-16 is sent as it is.
static inline uint32_t crc32_end(uint32_t crc) { return crc ^ 0xFFFFFFFFuL; }

/// CRC-16 of `count` octets, from beginning to end.
uint16_t crc16(const uint16_t* octets, uint16_t count);

#if defined(__cplusplus)
}
#endif

#endif

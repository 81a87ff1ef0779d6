// The format of a slot of the parameter store. All numbers little-endian; offsets in octets.
//
//    0  magic     u32  SLOT_MAGIC; the last thing that is written
//    4  version   u16  of this format
//    6  count     u16  entries
//    8  sequence  u32  one more with each save; the newer slot is the one that is ahead, also across the wrap
//   12  length    u16  octets of the entries
//   14  0         u16
//   16  entries        id u16, q u8, 0 u8, raw i32: number, fractional bits and value of a parameter
//   16 + length   CRC-32 of everything behind the magic
//
// Header, length and CRC keep their places in later versions, so that an older firmware can tell a newer slot from a
// damaged one.

#ifndef STILLSPIN_FIRMWARE_STORE_SLOT_H
#define STILLSPIN_FIRMWARE_STORE_SLOT_H

#include <stdbool.h>
#include <stdint.h>

#define SLOTS 2u
#define SLOT_SIZE 4096u          // slot n begins at n times this
#define SLOT_MAGIC 0x31505353uL  // "SSP1"
#define SLOT_MAGIC_OCTETS 4u
#define SLOT_VERSION 1u
#define SLOT_HEADER 16u
#define SLOT_ENTRY 8u
#define SLOT_CHECK 4u
#define SLOT_LENGTH_MAX (SLOT_SIZE - SLOT_HEADER - SLOT_CHECK)
#define SLOT_ENTRIES_MAX (SLOT_LENGTH_MAX / SLOT_ENTRY)

typedef struct {
  uint32_t magic;
  uint16_t version, count;
  uint32_t sequence;
  uint16_t length;
} slot_header_t;

typedef struct {
  uint16_t id, q;
  int32_t raw;
} slot_entry_t;

/// Of the two.
static inline uint16_t slot_other(uint16_t slot) { return (uint16_t)(1u - slot); }

void slot_pack_u32(uint32_t value, uint16_t* octets);
uint32_t slot_unpack_u32(const uint16_t* octets);

void slot_pack_header(const slot_header_t* header, uint16_t* octets);
void slot_unpack_header(const uint16_t* octets, slot_header_t* header);

void slot_pack_entry(const slot_entry_t* entry, uint16_t* octets);
void slot_unpack_entry(const uint16_t* octets, slot_entry_t* entry);

/// Whether a slot may be there: its CRC tells.
bool slot_is_plausible(const slot_header_t* header);

/// Whether nothing has ever been written there.
bool slot_is_blank(const uint16_t* header_octets);

/// Whether a sequence number is ahead of another one.
bool slot_is_newer(uint32_t sequence, uint32_t than);

#endif

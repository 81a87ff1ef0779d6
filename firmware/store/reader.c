#include "firmware/store/reader.h"

#include "firmware/base/crc.h"
#include "hal/hal_nvm.h"
#include "hal/qmath/qarith.h"

#define CHUNK 64u  // octets read at a time: eight entries

static uint16_t base;      // of the slot
static uint16_t position;  // in the slot: what has been read into the chunk
static uint16_t chunk[CHUNK];
static uint16_t used, held;  // octets of the chunk
static bool reading;         // the memory is being read
static uint32_t crc;
static slot_header_t header;

const slot_header_t* reader_header(void) { return &header; }

uint16_t reader_progress(void) {
  const uint32_t all = (uint32_t)header.length + SLOT_HEADER + SLOT_CHECK;
  return (position <= SLOT_HEADER) ? 0u : (uint16_t)(100uL * position / all);
}

static void read_on(uint16_t octets) {
  reading = hal_nvm_read((uint16_t)(base + position), chunk, octets);
  held = reading ? octets : 0u;
  used = 0;
}

void reader_begin(uint16_t slot) {
  base = (uint16_t)(slot * SLOT_SIZE);
  position = 0;
  crc = CRC32_BEGIN;
  read_on(SLOT_HEADER);
}

static void take(uint16_t octets) {
  for (uint16_t k = 0; k < octets; k++) crc = crc32_add(crc, chunk[used + k]);
}

// What has come is the header.
static reader_result_t take_header(void) {
  header = slot_unpack_header(chunk);
  used = SLOT_MAGIC_OCTETS;
  take(SLOT_HEADER - SLOT_MAGIC_OCTETS);
  used = SLOT_HEADER;
  if (header.length > SLOT_LENGTH_MAX) return READER_BAD;
  // Entries of another version are another version's business, but its check is not.
  if (header.version == SLOT_VERSION && header.length != (uint32_t)header.count * SLOT_ENTRY) return READER_BAD;
  return READER_WAITS;
}

static reader_result_t take_arrived(void) {
  const uint16_t before = position;
  reading = false;
  position = (uint16_t)(position + held);
  if (before == 0u) return take_header();
  if (before < SLOT_HEADER + header.length) return READER_WAITS;
  return (slot_unpack_u32(chunk) == crc32_end(crc)) ? READER_VALID : READER_BAD;
}

reader_result_t reader_step(slot_entry_t* entry) {
  if (used < held && !reading) {
    const uint16_t octets = (uint16_t)q_min(SLOT_ENTRY, held - used);
    *entry = slot_unpack_entry(chunk + used);
    take(octets);
    used = (uint16_t)(used + SLOT_ENTRY);  // the last one may be shorter: then that is all as well
    return (header.version == SLOT_VERSION) ? READER_ENTRY : READER_WAITS;
  }
  if (!reading && position == 0u) return READER_FAILED;  // the memory was busy
  if (!reading) {
    const uint16_t left = (uint16_t)(SLOT_HEADER + header.length - position);
    read_on((left == 0u) ? SLOT_CHECK : (uint16_t)q_min(CHUNK, left));
    return reading ? READER_WAITS : READER_FAILED;
  }
  switch (hal_nvm_step()) {
    case NVM_BUSY:
      return READER_WAITS;
    case NVM_DONE:
      return take_arrived();
    default:
      return READER_FAILED;
  }
}

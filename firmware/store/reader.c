#include "firmware/store/reader.h"

#include "firmware/base/crc.h"
#include "hal/hal_nvm.h"
#include "hal/qmath/qarith.h"

#define CHUNK 64u  // octets read at a time: eight entries

static struct {
  uint32_t crc;
  uint16_t base;        // of the slot
  uint16_t position;    // in the slot: what has been read into the chunk
  uint16_t used, held;  // octets of the chunk
  bool reading;         // the memory is being read
  slot_header_t header;
  uint16_t chunk[CHUNK];
} self;

const slot_header_t* reader_header(void) { return &self.header; }

uint16_t reader_progress(void) {
  const uint32_t all = (uint32_t)self.header.length + SLOT_HEADER + SLOT_CHECK;
  return (self.position <= SLOT_HEADER) ? 0u : (uint16_t)(100uL * self.position / all);
}

static void read_on(uint16_t octets) {
  self.reading = hal_nvm_read((uint16_t)(self.base + self.position), self.chunk, octets);
  self.held = self.reading ? octets : 0u;
  self.used = 0;
}

void reader_begin(uint16_t slot) {
  self.base = (uint16_t)(slot * SLOT_SIZE);
  self.position = 0;
  self.crc = CRC32_BEGIN;
  read_on(SLOT_HEADER);
}

static void take(uint16_t octets) { self.crc = crc32_add_all(self.crc, &self.chunk[self.used], octets); }

// What has come is the header.
static reader_result_t take_header(void) {
  slot_unpack_header(self.chunk, &self.header);
  self.used = SLOT_MAGIC_OCTETS;
  take(SLOT_HEADER - SLOT_MAGIC_OCTETS);
  self.used = SLOT_HEADER;
  if (self.header.length > SLOT_LENGTH_MAX) return READER_BAD;
  // Entries of another version are another version's business, but its check is not.
  if (self.header.version == SLOT_VERSION && self.header.length != (uint32_t)self.header.count * SLOT_ENTRY)
    return READER_BAD;
  return READER_WAITS;
}

static reader_result_t take_arrived(void) {
  const uint16_t before = self.position;
  self.reading = false;
  self.position = (uint16_t)(self.position + self.held);
  if (before == 0u) return take_header();
  if (before < SLOT_HEADER + self.header.length) return READER_WAITS;
  return (slot_unpack_u32(self.chunk) == crc32_end(self.crc)) ? READER_VALID : READER_BAD;
}

reader_result_t reader_step(slot_entry_t* entry) {
  if (self.used < self.held && !self.reading) {
    const uint16_t octets = (uint16_t)q_min(SLOT_ENTRY, self.held - self.used);
    slot_unpack_entry(self.chunk + self.used, entry);
    take(octets);
    self.used = (uint16_t)(self.used + SLOT_ENTRY);  // the last one may be shorter: then that is all as well
    return (self.header.version == SLOT_VERSION) ? READER_ENTRY : READER_WAITS;
  }
  if (!self.reading && self.position == 0u) return READER_FAILED;  // the memory was busy
  if (!self.reading) {
    const uint16_t left = (uint16_t)(SLOT_HEADER + self.header.length - self.position);
    read_on((left == 0u) ? SLOT_CHECK : (uint16_t)q_min(CHUNK, left));
    return self.reading ? READER_WAITS : READER_FAILED;
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

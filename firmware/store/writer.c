#include "firmware/store/writer.h"

#include "firmware/base/crc.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/store/reader.h"
#include "firmware/store/slot.h"
#include "firmware/store/values.h"
#include "hal/hal_nvm.h"

enum { COMPOSE, WRITE_PAGE, READ_BACK, WRITE_MAGIC, READ_MAGIC };

static struct {
  uint32_t crc;
  uint16_t stage;
  uint16_t old_slot, new_slot;  // old_slot: SLOTS when there is none
  uint16_t filled;              // octets of the page
  uint16_t written;             // octets of the slot in the memory
  uint16_t next;                // parameter, then of what is copied, to be written
  uint16_t unknown;             // entries of the old slot
  bool fetching;                // the old slot is being read
  bool complete;                // the check has been put into the page
  slot_header_t header;
  uint16_t page[HAL_NVM_PAGE];
} self;

static uint16_t slot_octets(void) { return (uint16_t)(SLOT_HEADER + self.header.length + SLOT_CHECK); }

// In the memory.
static uint16_t slot_begins(void) { return (uint16_t)(self.new_slot * SLOT_SIZE); }

// Where the memory has taken a job.
static writer_result_t goes_on(bool taken) { return taken ? WRITER_GOES_ON : WRITER_FAILED; }

uint16_t writer_progress(void) {
  const uint16_t share = (uint16_t)(90uL * self.written / slot_octets());
  if (self.stage == COMPOSE || self.stage == WRITE_PAGE) return share;
  return (self.stage == READ_BACK) ? (uint16_t)(90u + reader_progress() / 20u) : 95u;
}

void writer_report(store_report_t* report) {
  static const store_report_t nothing = {0};
  *report = nothing;
  report->slot = report->newest = self.new_slot;
  report->sequence = self.header.sequence;
  report->values = self.header.count;
  report->unknown = self.unknown;
}

static void put(uint16_t octets) {
  self.crc = crc32_add_all(self.crc, &self.page[self.filled], octets);
  self.filled = (uint16_t)(self.filled + octets);
}

bool writer_begin(const store_report_t* so_far) {
  if (so_far->unknown > SLOT_ENTRIES_MAX - parameter_count()) return false;
  self.old_slot = so_far->slot;
  // The newest slot is spared, also when another firmware wrote it and this one's own values lie in the other.
  self.new_slot = (so_far->newest == 0u) ? 1u : 0u;
  self.unknown = (self.old_slot < SLOTS && self.old_slot != self.new_slot) ? so_far->unknown : 0u;
  self.header.magic = 0xFFFFFFFFuL;
  self.header.version = SLOT_VERSION;
  self.header.count = (uint16_t)(parameter_count() + self.unknown);
  self.header.sequence = so_far->sequence + 1u;
  self.header.length = (uint16_t)(self.header.count * SLOT_ENTRY);
  slot_pack_header(&self.header, self.page);
  self.crc = CRC32_BEGIN;
  self.filled = SLOT_MAGIC_OCTETS;
  put(SLOT_HEADER - SLOT_MAGIC_OCTETS);
  self.written = self.next = 0;
  self.fetching = self.complete = false;
  self.stage = COMPOSE;
  return true;
}

static void put_entry(const slot_entry_t* entry) {
  slot_pack_entry(entry, self.page + self.filled);
  put(SLOT_ENTRY);
}

// The next unknown entry of the old slot, when it has arrived.
static writer_result_t copy_unknown(void) {
  slot_entry_t entry;
  if (!self.fetching) reader_begin(self.old_slot);
  self.fetching = true;
  switch (reader_step(&entry)) {
    case READER_WAITS:
      return WRITER_GOES_ON;
    case READER_ENTRY:
      if (values_know(entry.id)) return WRITER_GOES_ON;
      put_entry(&entry);
      self.next++;
      return WRITER_GOES_ON;
    default:
      return WRITER_FAILED;  // it has fewer than the scan counted, or cannot be read
  }
}

static writer_result_t compose(void) {
  if (self.complete || self.filled > HAL_NVM_PAGE - SLOT_ENTRY) {
    self.stage = WRITE_PAGE;
    return goes_on(hal_nvm_write((uint16_t)(slot_begins() + self.written), self.page, self.filled));
  }
  if (self.next < parameter_count()) {
    const slot_entry_t entry = values_entry(self.next++);
    put_entry(&entry);
    return WRITER_GOES_ON;
  }
  if (self.next < self.header.count) return copy_unknown();
  slot_pack_u32(crc32_end(self.crc), self.page + self.filled);
  self.filled = (uint16_t)(self.filled + SLOT_CHECK);
  self.complete = true;
  return WRITER_GOES_ON;
}

static writer_result_t on_written(void) {
  self.written = (uint16_t)(self.written + self.filled);
  self.filled = 0;
  if (!self.complete) {
    self.stage = COMPOSE;
  } else {
    self.stage = READ_BACK;
    reader_begin(self.new_slot);
  }
  return WRITER_GOES_ON;
}

static writer_result_t read_back(void) {
  slot_entry_t entry;
  switch (reader_step(&entry)) {
    case READER_WAITS:
    case READER_ENTRY:
      return WRITER_GOES_ON;
    case READER_VALID:
      break;
    default:
      return WRITER_FAILED;
  }
  if (reader_header()->sequence != self.header.sequence) return WRITER_FAILED;
  self.stage = WRITE_MAGIC;
  slot_pack_u32(SLOT_MAGIC, self.page);
  return goes_on(hal_nvm_write(slot_begins(), self.page, SLOT_MAGIC_OCTETS));
}

static writer_result_t on_magic_written(void) {
  self.stage = READ_MAGIC;
  self.page[0] = 0;
  return goes_on(hal_nvm_read(slot_begins(), self.page, SLOT_MAGIC_OCTETS));
}

writer_result_t writer_step(void) {
  if (self.stage == COMPOSE) return compose();
  if (self.stage == READ_BACK) return read_back();
  const hal_nvm_state_t state = hal_nvm_step();
  if (state == NVM_BUSY) return WRITER_GOES_ON;
  if (state != NVM_DONE) return WRITER_FAILED;
  if (self.stage == WRITE_PAGE) return on_written();
  if (self.stage == WRITE_MAGIC) return on_magic_written();
  return (slot_unpack_u32(self.page) == SLOT_MAGIC) ? WRITER_DONE : WRITER_FAILED;
}

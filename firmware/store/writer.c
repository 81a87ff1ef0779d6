#include "firmware/store/writer.h"

#include "firmware/base/crc.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/store/reader.h"
#include "firmware/store/slot.h"
#include "firmware/store/values.h"
#include "hal/hal_nvm.h"

typedef enum { COMPOSE, WRITE_PAGE, READ_BACK, WRITE_MAGIC, READ_MAGIC } stage_t;

static stage_t stage;
static uint16_t old_slot, new_slot;  // old_slot: SLOTS when there is none
static slot_header_t header;
static uint16_t page[HAL_NVM_PAGE];
static uint16_t filled;           // octets of the page
static uint16_t written;          // octets of the slot in the memory
static uint16_t next;             // parameter to be written
static uint16_t unknown, copied;  // entries of the old slot
static bool fetching;             // the old slot is being read
static bool complete;             // the check has been put into the page
static uint32_t crc;

static uint16_t slot_octets(void) { return (uint16_t)(SLOT_HEADER + header.length + SLOT_CHECK); }

uint16_t writer_progress(void) {
  const uint16_t share = (uint16_t)(90uL * written / slot_octets());
  if (stage == COMPOSE || stage == WRITE_PAGE) return share;
  return (stage == READ_BACK) ? (uint16_t)(90u + reader_progress() / 20u) : 95u;
}

store_report_t writer_report(void) {
  store_report_t report = {0};
  report.slot = report.newest = new_slot;
  report.sequence = header.sequence;
  report.values = header.count;
  report.unknown = unknown;
  return report;
}

static void put(uint16_t octets) {
  for (uint16_t k = 0; k < octets; k++) crc = crc32_add(crc, page[filled + k]);
  filled = (uint16_t)(filled + octets);
}

bool writer_begin(const store_report_t* so_far) {
  if (so_far->unknown > SLOT_ENTRIES_MAX - parameter_count()) return false;
  old_slot = so_far->slot;
  // The newest slot is spared, also when another firmware wrote it and this one's own values lie in the other.
  new_slot = (so_far->newest == 0u) ? 1u : 0u;
  unknown = (old_slot < SLOTS && old_slot != new_slot) ? so_far->unknown : 0u;
  header.magic = 0xFFFFFFFFuL;
  header.version = SLOT_VERSION;
  header.count = (uint16_t)(parameter_count() + unknown);
  header.sequence = so_far->sequence + 1u;
  header.length = (uint16_t)(header.count * SLOT_ENTRY);
  slot_pack_header(&header, page);
  crc = CRC32_BEGIN;
  filled = SLOT_MAGIC_OCTETS;
  put(SLOT_HEADER - SLOT_MAGIC_OCTETS);
  written = next = copied = 0;
  fetching = complete = false;
  stage = COMPOSE;
  return true;
}

static void put_entry(const slot_entry_t* entry) {
  slot_pack_entry(entry, page + filled);
  put(SLOT_ENTRY);
}

// The next unknown entry of the old slot, when it has arrived.
static writer_result_t copy_unknown(void) {
  slot_entry_t entry;
  if (!fetching) reader_begin(old_slot);
  fetching = true;
  switch (reader_step(&entry)) {
    case READER_WAITS:
      return WRITER_GOES_ON;
    case READER_ENTRY:
      if (values_know(entry.id)) return WRITER_GOES_ON;
      put_entry(&entry);
      copied++;
      return WRITER_GOES_ON;
    default:
      return WRITER_FAILED;  // it has fewer than the scan counted, or cannot be read
  }
}

static writer_result_t compose(void) {
  if (complete || filled > HAL_NVM_PAGE - SLOT_ENTRY) {
    stage = WRITE_PAGE;
    const uint16_t address = (uint16_t)(new_slot * SLOT_SIZE + written);
    return hal_nvm_write(address, page, filled) ? WRITER_GOES_ON : WRITER_FAILED;
  }
  if (next < parameter_count()) {
    const slot_entry_t entry = values_entry(next++);
    put_entry(&entry);
    return WRITER_GOES_ON;
  }
  if (copied < unknown) return copy_unknown();
  slot_pack_u32(crc32_end(crc), page + filled);
  filled = (uint16_t)(filled + SLOT_CHECK);
  complete = true;
  return WRITER_GOES_ON;
}

static writer_result_t on_written(void) {
  written = (uint16_t)(written + filled);
  filled = 0;
  if (!complete) {
    stage = COMPOSE;
  } else {
    stage = READ_BACK;
    reader_begin(new_slot);
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
  if (reader_header()->sequence != header.sequence) return WRITER_FAILED;
  stage = WRITE_MAGIC;
  slot_pack_u32(SLOT_MAGIC, page);
  return hal_nvm_write((uint16_t)(new_slot * SLOT_SIZE), page, SLOT_MAGIC_OCTETS) ? WRITER_GOES_ON : WRITER_FAILED;
}

static writer_result_t on_magic_written(void) {
  stage = READ_MAGIC;
  page[0] = 0;
  return hal_nvm_read((uint16_t)(new_slot * SLOT_SIZE), page, SLOT_MAGIC_OCTETS) ? WRITER_GOES_ON : WRITER_FAILED;
}

writer_result_t writer_step(void) {
  if (stage == COMPOSE) return compose();
  if (stage == READ_BACK) return read_back();
  const hal_nvm_state_t state = hal_nvm_step();
  if (state == NVM_BUSY) return WRITER_GOES_ON;
  if (state != NVM_DONE) return WRITER_FAILED;
  if (stage == WRITE_PAGE) return on_written();
  if (stage == WRITE_MAGIC) return on_magic_written();
  return (slot_unpack_u32(page) == SLOT_MAGIC) ? WRITER_DONE : WRITER_FAILED;
}

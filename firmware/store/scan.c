#include "firmware/store/scan.h"

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/store/reader.h"
#include "firmware/store/slot.h"
#include "firmware/store/values.h"
#include "hal/hal_nvm.h"

#define ENTRIES_IN_A_STEP 4u  // some 1000 cycles
#define HEADER_READS 4u       // of which two in a row must agree: nothing else tells that its number is right
#define SLOT_READS 2u

enum { LOOK_AT_HEADERS, CHECK_SLOT };

static struct {
  uint16_t stage;
  bool staging;
  uint16_t slot;  // whose header is being read, or which is being checked
  bool any_foreign;
  bool arrives;    // the memory has taken the job of reading a header
  uint16_t reads;  // of what is being read
  bool candidate[SLOTS];
  bool spoilt[SLOTS];  // something is there that is no valid slot
  store_report_t report;
  slot_header_t headers[SLOTS];
  uint16_t octets[SLOT_HEADER];
  uint16_t before[SLOT_HEADER];  // the header as it was read the time before
} self;

const store_report_t* scan_report(void) { return &self.report; }

uint16_t scan_progress(void) { return (self.stage == CHECK_SLOT) ? reader_progress() : 0u; }

static void read_header(uint16_t of) {
  self.slot = of;
  self.arrives = hal_nvm_read((uint16_t)(of * SLOT_SIZE), self.octets, SLOT_HEADER);
}

static void begin_check(void) {
  self.report.values = self.report.rescaled = self.report.refused = self.report.first_refused = self.report.unknown =
      self.report.left_out = 0;
  if (self.staging) values_reset();
  reader_begin(self.slot);
}

// A disturbance on the bus is no damage. False when it has been read often enough.
static bool read_again(void) {
  self.reads++;
  if (self.stage == CHECK_SLOT) {
    if (self.reads >= SLOT_READS) return false;
    begin_check();
  } else {
    if (self.reads >= HEADER_READS) return false;
    read_header(self.slot);
  }
  return true;
}

void scan_begin(bool stage_values) {
  static const store_report_t nothing = {0};
  self.staging = stage_values;
  self.stage = LOOK_AT_HEADERS;
  self.any_foreign = false;
  self.reads = 0;
  self.report = nothing;
  self.report.slot = self.report.newest = SLOTS;
  read_header(0);
}

// Whether what the other slot has, or had, may be younger than the slot that was found.
static bool is_outrun(void) {
  const uint16_t slot = self.report.slot;
  const uint16_t other = slot_other(slot);
  return self.report.newest != slot ||
         (self.spoilt[other] && slot_is_newer(self.headers[other].sequence, self.headers[slot].sequence));
}

static scan_result_t conclude(void) {
  if (self.report.slot < SLOTS) {
    self.report.older = is_outrun();
    return SCAN_FOUND;
  }
  if (self.any_foreign) return SCAN_FOREIGN;
  return (self.report.damaged > 0u) ? SCAN_DAMAGED : SCAN_EMPTY;
}

// The newer slot, where it has not been checked yet, else the other one.
static scan_result_t check_next(void) {
  uint16_t next = slot_is_newer(self.headers[1].sequence, self.headers[0].sequence) ? 1u : 0u;
  if (!self.candidate[next]) next = slot_other(next);
  if (!self.candidate[next]) return conclude();
  self.slot = next;
  self.candidate[next] = false;
  self.stage = CHECK_SLOT;
  self.reads = 0;
  begin_check();
  return SCAN_GOES_ON;
}

static void give_up_slot(void) {
  self.spoilt[self.slot] = true;
  self.report.damaged++;
}

// Whether it has come twice in a row.
static bool header_is_sure(void) {
  bool same = self.reads > 0u;
  for (uint16_t k = 0; k < SLOT_HEADER; k++) {
    if (self.octets[k] != self.before[k]) same = false;
    self.before[k] = self.octets[k];
  }
  return same;
}

static scan_result_t take_header(void) {
  if (!header_is_sure() && read_again()) return SCAN_GOES_ON;
  slot_header_t* const header = &self.headers[self.slot];
  slot_unpack_header(self.octets, header);
  self.candidate[self.slot] = slot_is_plausible(header);
  self.spoilt[self.slot] = false;
  if (!self.candidate[self.slot] && !slot_is_blank(self.octets)) give_up_slot();
  self.reads = 0;
  if (self.slot + 1u == SLOTS) return check_next();
  read_header((uint16_t)(self.slot + 1u));
  return SCAN_GOES_ON;
}

static void take_entry(const slot_entry_t* entry) {
  self.report.values++;
  if (!self.staging) {
    if (!values_know(entry->id)) self.report.unknown++;
    return;
  }
  switch (values_put(entry)) {
    case VALUE_RESCALED:
      self.report.rescaled++;
      break;
    case VALUE_REFUSED:
      if (self.report.refused == 0u) self.report.first_refused = entry->id;
      self.report.refused++;
      break;
    case VALUE_UNKNOWN:
      self.report.unknown++;
      if (parameter_is_left_out(entry->id)) self.report.left_out++;
      break;
    default:
      break;
  }
}

// A valid slot: the one to take, unless another firmware's format keeps it from being read.
static scan_result_t take_slot(void) {
  if (self.report.newest == SLOTS) {
    self.report.newest = self.slot;
    self.report.sequence = self.headers[self.slot].sequence;
  }
  if (self.headers[self.slot].version != SLOT_VERSION) {
    self.any_foreign = true;
    return check_next();
  }
  self.report.slot = self.slot;
  if (self.staging) values_complete();
  self.report.missing = (uint16_t)(parameter_count() + self.report.unknown - self.report.values);
  return conclude();
}

scan_result_t scan_step(void) {
  if (self.stage == LOOK_AT_HEADERS) {
    const hal_nvm_state_t state = self.arrives ? hal_nvm_step() : NVM_FAILED;
    if (state == NVM_BUSY) return SCAN_GOES_ON;
    if (state == NVM_DONE) return take_header();
    return read_again() ? SCAN_GOES_ON : SCAN_FAILED;
  }
  slot_entry_t entry;
  reader_result_t result = reader_step(&entry);
  for (uint16_t k = 1; result == READER_ENTRY; k++) {
    take_entry(&entry);
    if (k == ENTRIES_IN_A_STEP) return SCAN_GOES_ON;
    result = reader_step(&entry);
  }
  switch (result) {
    case READER_VALID:
      return take_slot();
    case READER_BAD:
      if (read_again()) return SCAN_GOES_ON;
      give_up_slot();
      return check_next();
    case READER_FAILED:
      return read_again() ? SCAN_GOES_ON : SCAN_FAILED;
    default:
      return SCAN_GOES_ON;
  }
}

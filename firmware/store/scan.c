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

typedef enum { LOOK_AT_HEADERS, CHECK_SLOT } stage_t;

static bool staging;
static stage_t stage;
static uint16_t slot;  // whose header is being read, or which is being checked
static uint16_t octets[SLOT_HEADER];
static slot_header_t headers[SLOTS];
static bool candidate[SLOTS];
static bool spoilt[SLOTS];  // something is there that is no valid slot
static bool any_foreign;
static bool arrives;                  // the memory has taken the job of reading a header
static uint16_t reads;                // of what is being read
static uint16_t before[SLOT_HEADER];  // the header as it was read the time before
static store_report_t report;

const store_report_t* scan_report(void) { return &report; }

uint16_t scan_progress(void) { return (stage == CHECK_SLOT) ? reader_progress() : 0u; }

static void read_header(uint16_t of) {
  slot = of;
  arrives = hal_nvm_read((uint16_t)(of * SLOT_SIZE), octets, SLOT_HEADER);
}

static void begin_check(void) {
  report.values = report.rescaled = report.refused = report.first_refused = report.unknown = report.left_out = 0;
  if (staging) values_reset();
  reader_begin(slot);
}

// A disturbance on the bus is no damage. False when it has been read often enough.
static bool read_again(void) {
  reads++;
  if (stage == CHECK_SLOT) {
    if (reads >= SLOT_READS) return false;
    begin_check();
  } else {
    if (reads >= HEADER_READS) return false;
    read_header(slot);
  }
  return true;
}

void scan_begin(bool stage_values) {
  static const store_report_t nothing = {0};
  staging = stage_values;
  stage = LOOK_AT_HEADERS;
  any_foreign = false;
  reads = 0;
  report = nothing;
  report.slot = report.newest = SLOTS;
  read_header(0);
}

// Whether what another slot has, or had, may be younger than the slot that was found.
static bool is_outrun(void) {
  if (report.newest != report.slot) return true;
  for (uint16_t k = 0; k < SLOTS; k++) {
    if (spoilt[k] && slot_is_newer(headers[k].sequence, headers[report.slot].sequence)) return true;
  }
  return false;
}

static scan_result_t conclude(void) {
  if (report.slot < SLOTS) report.older = is_outrun();
  if (report.slot < SLOTS) return SCAN_FOUND;
  if (any_foreign) return SCAN_FOREIGN;
  return (report.damaged > 0u) ? SCAN_DAMAGED : SCAN_EMPTY;
}

// The newest slot that has not been checked yet.
static scan_result_t check_next(void) {
  uint16_t newest = SLOTS;
  for (uint16_t k = 0; k < SLOTS; k++) {
    if (!candidate[k]) continue;
    if (newest == SLOTS || slot_is_newer(headers[k].sequence, headers[newest].sequence)) newest = k;
  }
  if (newest == SLOTS) return conclude();
  slot = newest;
  candidate[slot] = false;
  stage = CHECK_SLOT;
  reads = 0;
  begin_check();
  return SCAN_GOES_ON;
}

static void give_up_slot(void) {
  spoilt[slot] = true;
  report.damaged++;
}

// Whether it has come twice in a row.
static bool header_is_sure(void) {
  bool same = reads > 0u;
  for (uint16_t k = 0; k < SLOT_HEADER; k++) {
    if (octets[k] != before[k]) same = false;
    before[k] = octets[k];
  }
  return same;
}

static scan_result_t take_header(void) {
  if (!header_is_sure() && read_again()) return SCAN_GOES_ON;
  headers[slot] = slot_unpack_header(octets);
  candidate[slot] = slot_is_plausible(&headers[slot]);
  spoilt[slot] = false;
  if (!candidate[slot] && !slot_is_blank(octets)) give_up_slot();
  reads = 0;
  if (slot + 1u == SLOTS) return check_next();
  read_header((uint16_t)(slot + 1u));
  return SCAN_GOES_ON;
}

static void take_entry(const slot_entry_t* entry) {
  report.values++;
  if (!staging) {
    if (!values_know(entry->id)) report.unknown++;
    return;
  }
  switch (values_put(entry)) {
    case VALUE_RESCALED:
      report.rescaled++;
      break;
    case VALUE_REFUSED:
      if (report.refused == 0u) report.first_refused = entry->id;
      report.refused++;
      break;
    case VALUE_UNKNOWN:
      report.unknown++;
      if (parameter_is_left_out(entry->id)) report.left_out++;
      break;
    default:
      break;
  }
}

// A valid slot: the one to take, unless another firmware's format keeps it from being read.
static scan_result_t take_slot(void) {
  if (report.newest == SLOTS) {
    report.newest = slot;
    report.sequence = headers[slot].sequence;
  }
  if (headers[slot].version != SLOT_VERSION) {
    any_foreign = true;
    return check_next();
  }
  report.slot = slot;
  if (staging) values_complete();
  report.missing = (uint16_t)(parameter_count() + report.unknown - report.values);
  return conclude();
}

scan_result_t scan_step(void) {
  if (stage == LOOK_AT_HEADERS) {
    const hal_nvm_state_t state = arrives ? hal_nvm_step() : NVM_FAILED;
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

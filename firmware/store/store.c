#include "firmware/store/store.h"

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/store/scan.h"
#include "firmware/store/slot.h"
#include "firmware/store/values.h"
#include "firmware/store/writer.h"

// feature_status.store_work
enum { WORK_NONE, WORK_LOAD, WORK_SCAN, WORK_WRITE };

static struct {
  uint16_t state;    // store_state_t
  bool begun;        // false: asked for, store_service begins
  bool kept_known;   // the staged set is what the next power-on will have
  uint16_t unsaved;  // as long as the staged set is at work
  store_report_t report;
} self;

store_state_t store_state(void) { return (store_state_t)self.state; }

bool store_is_busy(void) { return feature_status.store_work != WORK_NONE; }

const store_report_t* store_report(void) { return &self.report; }

uint16_t store_progress(void) {
  if (store_is_busy() && !self.begun) return 0;
  switch (feature_status.store_work) {
    case WORK_LOAD:
      return scan_progress();
    case WORK_SCAN:
      return (uint16_t)(scan_progress() / 10u);
    case WORK_WRITE:
      return (uint16_t)(10u + 9u * writer_progress() / 10u);
    default:
      return 100;
  }
}

uint16_t store_unsaved(void) {
  if (!store_is_busy()) self.unsaved = self.kept_known ? values_changed() : UNSAVED_UNKNOWN;
  return self.unsaved;
}

void store_status_update(void) {
  feature_status.store_state = self.state;
  feature_status.store_progress = store_progress();
  feature_status.unsaved = store_unsaved();
}

void store_reset(void) {
  static const store_report_t nothing = {0};
  values_reset();
  self.kept_known = true;
  self.unsaved = 0;
  feature_status.store_work = WORK_NONE;
  feature_status.loading = false;
  self.state = STORE_EMPTY;
  self.report = nothing;
  self.report.slot = SLOTS;
}

static void begin(uint16_t what, store_state_t meanwhile) {
  (void)store_unsaved();
  feature_status.store_work = what;
  self.state = (uint16_t)meanwhile;
  self.begun = false;
}

void store_begin(void) {
  begin(WORK_LOAD, STORE_READING);
  store_service();
}

bool store_load(void) {
  if (store_is_busy() || drive_is_energised()) return false;
  begin(WORK_LOAD, STORE_READING);
  return true;
}

bool store_save(void) {
  if (store_is_busy()) return false;
  begin(WORK_SCAN, STORE_SAVING);
  values_copy();
  return true;
}

bool store_defaults(void) {
  if (store_is_busy()) return false;
  drive_parameters_changed();  // no start from here on until the background has taken the change
  if (drive_is_energised()) return false;
  parameters_reset(&parameters);
  return true;
}

static void end(store_state_t result) {
  feature_status.store_work = WORK_NONE;
  self.state = (uint16_t)result;
}

// The staged set into force, as a whole or not at all.
static store_state_t take_over(void) {
  drive_parameters_changed();  // first: no start from here on until the background has taken the change
  if (drive_is_energised()) return STORE_FAILED;
  values_swap();
  if (parameter_conflict() != PACKED_NONE) {
    values_swap();
    return STORE_CONFLICT;
  }
  if (self.report.older) return STORE_OLDER;
  const store_report_t* const r = &self.report;
  const bool other_firmware = (r->rescaled | r->refused | r->missing) != 0u || r->unknown > r->left_out;
  return other_firmware ? STORE_MIGRATED : STORE_LOADED;
}

// The values in force are the kept ones, or nothing that can be used is kept: the next power-on has the defaults.
static void end_load(store_state_t result) {
  end(result);
  self.kept_known = true;
  if (result == STORE_LOADED || result == STORE_MIGRATED || result == STORE_OLDER) {
    values_copy();
  } else if (result != STORE_FAILED) {
    values_reset();
  }
}

static void load(void) {
  static const uint16_t nothing_found[] = {[SCAN_EMPTY] = STORE_EMPTY,
                                           [SCAN_DAMAGED] = STORE_DAMAGED,
                                           [SCAN_FOREIGN] = STORE_FOREIGN,
                                           [SCAN_FAILED] = STORE_ABSENT};
  const scan_result_t result = scan_step();
  if (result == SCAN_GOES_ON) return;
  self.report = *scan_report();
  end_load((result == SCAN_FOUND) ? take_over() : (store_state_t)nothing_found[result]);
}

// Which slot may be written, and what of the other one must be kept.
static void scan(void) {
  const scan_result_t result = scan_step();
  if (result == SCAN_GOES_ON) return;
  if (result == SCAN_FAILED || !writer_begin(scan_report())) {
    self.kept_known = false;
    end(STORE_FAILED);
  } else {
    feature_status.store_work = WORK_WRITE;
  }
}

static void save(void) {
  const writer_result_t result = writer_step();
  if (result == WRITER_GOES_ON) return;
  self.kept_known = result == WRITER_DONE;
  if (self.kept_known) writer_report(&self.report);
  end(self.kept_known ? STORE_SAVED : STORE_FAILED);
}

void store_service(void) {
  if (store_is_busy() && !self.begun) {
    self.begun = true;
    scan_begin(feature_status.store_work == WORK_LOAD);
    return;
  }
  switch (feature_status.store_work) {
    case WORK_LOAD:
      load();
      break;
    case WORK_SCAN:
      scan();
      break;
    case WORK_WRITE:
      save();
      break;
    default:
      break;
  }
}

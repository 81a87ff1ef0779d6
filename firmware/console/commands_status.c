// status.

#include <stddef.h>

#include "firmware/api/actions.h"
#include "firmware/api/status.h"
#include "firmware/config/rules.h"
#include "firmware/console/commands.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/console/status_text.h"
#include "firmware/dictionary/units.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#define COLUMN 12u

static void put_limits(octet_writer_t* w, int32_t limits) {
  bool any = false;
  uint32_t left = (uint32_t)limits;
  for (uint16_t bit = 0; message_exists(CATALOGUE_LIMIT, bit); bit++, left >>= 1) {
    if ((left & 1u) == 0u) continue;
    if (any) put_packed(w, SAY_comma);
    put_message(w, CATALOGUE_LIMIT, bit);
    any = true;
  }
  if (!any) put_packed(w, SAY_none);
}

static void put_speeds(octet_writer_t* w) {
  const drive_signals_t s = drive_signals();
  if (s.speed_known != 0) put_fixed(w, s.speed, 16, 1);
  put_packed(w, (s.speed_known != 0) ? SAY_rpm_of : SAY_unknown_the_shaft_may_be_turning);
  put_fixed(w, drive_commanded_speed(), 16, 1);
  put_packed(w, SAY_rpm);
}

static void status_state(octet_writer_t* w) {
  put_message(w, CATALOGUE_STATE, (uint16_t)drive.state);
  if (drive.state == DRIVE_START) {
    put_packed(w, SAY_colon);
    put_message(w, CATALOGUE_START, (uint16_t)drive_signals().start_phase);
  } else if (drive.state == DRIVE_COMMISSION) {
    put_packed(w, SAY_colon);
    status_update();
    put_message(w, CATALOGUE_PHASE, feature_status.commissioning_phase);
  }
}

void put_current_pair(octet_writer_t* w, packed_text_t before, int32_t first_q20, packed_text_t between,
                      int32_t second_q20) {
  put_packed(w, before);
  put_quantity(w, first_q20, UNIT_A, 20, 2);
  put_packed(w, between);
  put_quantity(w, second_q20, UNIT_A, 20, 2);
  put_packed(w, SAY_amperes);
}

// With the gates off there is no d and no q: what the sensors read.
static void status_current(octet_writer_t* w) {
  const drive_signals_t s = drive_signals();
  if ((drive_known(&drive) & KNOWN_FRAME) != 0u) {
    put_current_pair(w, SAY_d, s.current_d, SAY_a_q, s.current_q);
  } else {
    put_current_pair(w, SAY_phase_a, s.current_a, SAY_a_phase_b, s.current_b);
  }
}

static void status_link(octet_writer_t* w) {
  put_quantity(w, drive_signals().link_voltage, UNIT_V, 16, 1);
  put_packed(w, SAY_volts);
}

static void status_limits(octet_writer_t* w) { put_limits(w, drive_signals().limit); }

static void status_fault(octet_writer_t* w) {
  const uint16_t fault = (uint16_t)drive.fault;
  put_message(w, CATALOGUE_FAULT, fault);
  if (fault == FAULT_NONE) return;
  if (fault >= FAULT_OPEN_PHASE && feature_status.wiring != 0u) {
    put_packed(w, SAY_colon);
    put_message(w, CATALOGUE_WIRING, feature_status.wiring);
  }
  put_packed(w, SAY_full_stop);
  put_message(w, CATALOGUE_REMEDY, fault);
}

void put_unsaved(octet_writer_t* w) {
  status_update();
  const uint16_t unsaved = feature_status.unsaved;
  if (unsaved == 0u) return;
  if (unsaved < UNSAVED_UNKNOWN) {
    put_packed(w, SAY_semicolon);
    put_count(w, unsaved, SAY_not_saved_save_keeps_them);
  } else {
    put_packed(w, SAY_not_saved_the_last_save_failed);
  }
}

static void status_parameters(octet_writer_t* w) {
  const packed_text_t conflict = parameter_conflict_known();
  if (conflict == PACKED_NONE) {
    put_packed(w, SAY_fit_together);
  } else {
    put_conflict(w, conflict);
  }
  put_unsaved(w);
}

const status_line_t state_line = {TEXT_SIGNAL_NAME_state, status_state};
const status_line_t speed_line = {TEXT_SIGNAL_NAME_speed, put_speeds};
const status_line_t current_line = {SAY_title_current, status_current};
const status_line_t dc_link_line = {SAY_title_dc_link, status_link};
const status_line_t limits_line = {SAY_title_limits, status_limits};
const status_line_t fault_line = {TEXT_SIGNAL_NAME_fault, status_fault};
const status_line_t parameters_line = {SAY_title_parameters, status_parameters};

static bool show_status(uint16_t step) {
  octet_writer_t* const w = line_begin();
  put_packed(w, edition_status_lines[step]->title);
  put_spaces_to(w, COLUMN);
  edition_status_lines[step]->put(w);
  line_end();
  return edition_status_lines[step + 1u] != NULL;
}

void command_status(const words_of_line_t* a) {
  (void)a;
  console_run(show_status, false);
}

void put_overview(octet_writer_t* w) {
  status_state(w);
  put_packed(w, SAY_gap);
  put_speeds(w);
  put_packed(w, SAY_gap);
  status_current(w);
  put_packed(w, SAY_gap);
  status_link(w);
  if (drive_signals().limit == 0) return;
  put_packed(w, SAY_gap);
  put_limits(w, drive_signals().limit);
}

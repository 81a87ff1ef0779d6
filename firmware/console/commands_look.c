// status, watch, faults, signals, version.

#include <stddef.h>

#include "firmware/api/actions.h"
#include "firmware/api/status.h"
#include "firmware/base/edition.h"
#include "firmware/config/rules.h"
#include "firmware/console/commands.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/console/signal_text.h"
#include "firmware/console/suggest.h"
#include "firmware/dictionary/version.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#define COLUMN 12u
#define WATCH_MS 500u
#define WATCH_SIGNALS 4u

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
  put_fixed(w, drive.control.command_rpm_q16, 16, 1);
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

static void put_pair(octet_writer_t* w, packed_text_t before, int32_t first_q20, packed_text_t between,
                     int32_t second_q20) {
  put_packed(w, before);
  put_fixed(w, first_q20, 20, 2);
  put_packed(w, between);
  put_fixed(w, second_q20, 20, 2);
  put_packed(w, SAY_amperes);
}

// With the gates off there is no d and no q: what the sensors read.
static void status_current(octet_writer_t* w) {
  const drive_signals_t s = drive_signals();
  if ((drive_known(&drive) & KNOWN_FRAME) != 0u) {
    put_pair(w, SAY_d, s.current_d, SAY_a_q, s.current_q);
  } else {
    put_pair(w, SAY_phase_a, s.current_a, SAY_a_phase_b, s.current_b);
  }
}

static void status_link(octet_writer_t* w) {
  put_fixed(w, drive_signals().link_voltage, 16, 1);
  put_packed(w, SAY_volts);
}

static void status_limits(octet_writer_t* w) { put_limits(w, drive_signals().limit); }

static void status_fault(octet_writer_t* w) {
  const uint16_t fault = (uint16_t)drive.fault;
  put_message(w, CATALOGUE_FAULT, fault);
  if (fault == FAULT_NONE) return;
  if (fault >= FAULT_OPEN_PHASE && drive.found.wiring != WIRING_GOOD) {
    put_packed(w, SAY_colon);
    put_message(w, CATALOGUE_WIRING, (uint16_t)drive.found.wiring);
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
    put_unsigned(w, unsaved);
  }
  put_packed(w, (unsaved < UNSAVED_UNKNOWN) ? SAY_not_saved_save_keeps_them : SAY_not_saved_the_last_save_failed);
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

const status_line_t state_line = {"state", status_state};
const status_line_t speed_line = {"speed", put_speeds};
const status_line_t current_line = {"current", status_current};
const status_line_t dc_link_line = {"DC link", status_link};
const status_line_t limits_line = {"limits", status_limits};
const status_line_t fault_line = {"fault", status_fault};
const status_line_t parameters_line = {"parameters", status_parameters};

static bool show_status(uint16_t step) {
  octet_writer_t* const w = line_begin();
  put_text(w, edition_status_lines[step]->title);
  put_spaces_to(w, COLUMN);
  edition_status_lines[step]->put(w);
  line_end();
  return edition_status_lines[step + 1u] != NULL;
}

void command_status(const words_of_line_t* a) {
  (void)a;
  console_run(show_status, false);
}

static uint16_t watched[WATCH_SIGNALS];
static uint16_t watched_count;
static uint32_t shown_ms;

static void put_watched(octet_writer_t* w) {
  for (uint16_t k = 0; k < watched_count; k++) {
    if (k > 0u) put_packed(w, SAY_gap);
    put_packed(w, signal_info(watched[k])->name);
    put_u8(w, ' ');
    put_signal(w, watched[k]);
  }
}

static void put_overview(octet_writer_t* w) {
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

static bool watch(uint16_t step) {
  if (step > 0u && drive_time_ms() - shown_ms < WATCH_MS) return true;
  shown_ms = drive_time_ms();
  octet_writer_t* const w = line_begin();
  if (watched_count > 0u) {
    put_watched(w);
  } else {
    put_overview(w);
  }
  line_end();
  return true;
}

void command_watch(const words_of_line_t* a) {
  watched_count = 0;
  if (a->count > WATCH_SIGNALS) {
    line_refused(SAY_watch_shows_at_most_four_signals);
    return;
  }
  for (uint16_t k = 0; k < a->count; k++) {
    const uint16_t place = signal_find(&a->word[k]);
    if (place == SIGNAL_NONE) {
      suggest(SUGGEST_SIGNAL, &a->word[k]);
      return;
    }
    watched[k] = place;
  }
  watched_count = a->count;
  console_run(watch, true);
}

static void put_fault(octet_writer_t* w, const fault_record_t* f) {
  put_unsigned(w, f->time_ms / 1000u);
  put_u8(w, '.');
  put_unsigned(w, f->time_ms / 100u % 10u);
  put_unsigned(w, f->time_ms / 10u % 10u);
  put_unsigned(w, f->time_ms % 10u);
  put_packed(w, SAY_s);
  put_message(w, CATALOGUE_FAULT, (uint16_t)f->fault);
  put_packed(w, SAY_comma);
  put_message(w, CATALOGUE_STATE, (uint16_t)f->state);
  const bool turned = (f->known & KNOWN_ROTOR) != 0u;
  if (turned) {
    put_packed(w, SAY_at);
    put_fixed(w, f->speed_q16, 16, 1);
  }
  put_packed(w, turned ? SAY_rpm_link : SAY_speed_unknown_link);
  put_fixed(w, f->link_q16, 16, 1);
  if ((f->known & KNOWN_FRAME) != 0u) {
    put_pair(w, SAY_v_d, f->current_d_q20, SAY_a_q, f->current_q_q20);
  } else {
    put_packed(w, SAY_volts);
  }
}

static bool list_faults(uint16_t step) {
  fault_record_t f;
  octet_writer_t* const w = line_begin();
  if (step == 0u) {
    put_unsigned(w, fault_history_total());
    put_packed(w, SAY_since_power_on_which_was);
    put_unsigned(w, drive_time_ms() / 1000u);
    put_packed(w, SAY_s_ago_the_newest_first);
  } else if (fault_history_read((uint16_t)(step - 1u), &f)) {
    put_fault(w, &f);
  } else {
    return false;
  }
  line_end();
  return true;
}

void command_faults(const words_of_line_t* a) {
  (void)a;
  if (fault_history_total() == 0u) {
    line_of(SAY_no_fault_since_power_on);
  } else {
    console_run(list_faults, false);
  }
}

static word_t pattern;

static bool list_signals(uint16_t step) {
  const signal_info_t* const s = signal_info(step);
  if (s == NULL) return false;
  if (signal_is_left_out(step)) return true;
  if (!word_occurs(&pattern, s->name) && !word_occurs(&pattern, signal_meaning(s))) return true;
  put_signal_row(line_begin(), step);
  line_end();
  return true;
}

void command_signals(const words_of_line_t* a) {
  pattern.text = NULL;
  pattern.count = 0;
  if (a->count > 0u) pattern = a->word[0];
  console_run(list_signals, false);
}

void command_version(const words_of_line_t* a) {
  (void)a;
  octet_writer_t* const w = line_begin();
  put_text(w, FIRMWARE_NAME);
  put_packed(w, SAY_protocol);
  put_unsigned(w, LINK_PROTOCOL);
  put_packed(w, SAY_edition);
  put_text(w, edition_name);
  line_end();
}

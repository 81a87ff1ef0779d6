#include "firmware/console/console.h"

#include <stddef.h>

#include "firmware/api/actions.h"
#include "firmware/api/comm_watchdog.h"
#include "firmware/console/commands.h"
#include "firmware/console/editor.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/fault_history.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "hal/hal_sci.h"

#define KEPT 64u                                   // characters typed ahead; a power of two
#define ROOM (TEXT_LINE_MAX + RECORD_ON_WIRE_MAX)  // a line, and the answer to a record beside it
#define EXPIRES_MS 5000u
#define AFTER_PAUSE 0x100u  // beside an octet: nothing had come for EXPIRES_MS
#define CTRL_C 0x03u
#define BEHIND_KEYS 0x7Fu
#define LINE_FEED 0x0Au
#define RETURN 0x0Du

static struct {
  uint32_t heard_ms;
  uint16_t kept_first, kept_count;
  bool someone_types;
  uint16_t faults_shown;
  uint16_t errors_before;  // of the port, when the line began
  uint16_t errors_at_key;
  bool silence_shown;
  editor_t editor;
  editor_line_t command;  // the one that is being answered
  uint16_t kept[KEPT];
} self;
static editor_line_t ahead;  // the last line of those that were typed ahead

void console_reset(void) {
  editor_reset(&self.editor);
  output_reset();
  console_work.function = NULL;
  self.kept_first = 0;
  self.kept_count = 0;
  self.someone_types = false;
  self.faults_shown = 0;
  self.errors_before = 0;
  self.errors_at_key = 0;
  self.heard_ms = 0;
  self.silence_shown = false;
}

static void give_way(void) { self.someone_types = false; }

static void prompt(void) {
  put_text(line_begin(), EDITOR_PROMPT);
  line_flush();
}

static void end_job(void) {
  console_work.function = NULL;
  prompt();
}

static uint16_t port_errors(void) {
  const hal_sci_errors_t e = hal_sci_errors();
  return (uint16_t)(e.framing + e.overrun + e.breaks + e.lost);
}

// What a disturbed line says may be something else than what was sent. Only what makes the drive safe is done all the
// same.
static void obey(void) {
  self.command = self.editor.line;
  const bool damaged = self.editor.disturbed || port_errors() != self.errors_before;
  if (self.editor.too_long) {
    line_refused(SAY_a_line_has_at_most_80_characters);
  } else if (damaged && !command_makes_safe(&self.command)) {
    line_refused(SAY_the_line_was_disturbed_on_its_way);
  } else {
    command_obey(&self.command, self.editor.expired);
  }
}

static void edit(uint16_t octet) {
  if (self.editor.line.count == 0u) {  // what it had was taken back
    self.editor.expired = self.editor.cut;
    self.errors_before = port_errors();
  } else if ((octet & AFTER_PAUSE) != 0u) {
    self.editor.expired = true;
  }
  const editor_event_t event = editor_octet(&self.editor, octet, line_begin());
  line_flush();
  if (event == EDITOR_DONE) {
    obey();
    editor_next(&self.editor);
  }
  if (event != EDITOR_NOTHING && console_work.function == NULL) prompt();
}

static bool keeps_more(void) { return self.kept_count < KEPT; }

static void keep(uint16_t octet) {
  self.kept[(uint16_t)(self.kept_first + self.kept_count) & (KEPT - 1u)] = octet;
  self.kept_count++;
}

static void break_off(void) {
  self.kept_count = 0;
  line_of(SAY_ctrl_c);
  end_job();
}

// Whether what was typed ahead ends with a line that stops the motor.
static bool asks_to_stop(void) {
  ahead.count = 0;
  for (uint16_t k = 0; k + 1u < self.kept_count; k++) {
    const uint16_t octet = self.kept[(uint16_t)(self.kept_first + k) & (KEPT - 1u)] & 0xFFu;
    if (octet == RETURN || octet == LINE_FEED) {
      ahead.count = 0;
    } else {
      ahead.text[ahead.count++ & (KEPT - 1u)] = octet;  // there are fewer
    }
  }
  return command_makes_safe(&ahead);
}

// To stop does not wait for the end of a long answer.
static void stop_at_once(void) {
  console_work.function = NULL;
  self.kept_count = 0;
  line_of(SAY_the_answer_and_what_was_typed_ahead);
  command_obey(&ahead, false);
  prompt();
}

static void cut(void) {
  editor_cut(&self.editor, self.kept_count > 0u);
  self.kept_count = 0;
}

// What a loose cable sends is nobody's key. Zeros do not come here: they are the ends of records.
static bool is_key(uint16_t octet) {
  const uint16_t errors = port_errors();
  const bool clean = errors == self.errors_at_key;
  self.errors_at_key = errors;
  return clean && octet < BEHIND_KEYS;
}

// The space bar that holds the motor neither fills the line nor ends an answer.
static bool only_holds(uint16_t octet) {
  return is_key(octet) && comm_watchdog_key() && octet == ' ' && self.editor.line.count == 0u && self.kept_count == 0u;
}

static void take_key(uint16_t octet) {
  if (octet == TEXT_BREAK) {
    cut();
    return;
  }
  const uint32_t pause_ms = drive_time_ms() - self.heard_ms;
  self.heard_ms += pause_ms;
  self.someone_types = true;
  if (only_holds(octet)) return;
  if (console_work.function != NULL && octet == CTRL_C) {
    break_off();
    return;
  }
  if (console_work.function != NULL && console_work.ends_by_key) end_job();
  if (pause_ms >= EXPIRES_MS) octet |= AFTER_PAUSE;
  if (console_work.function == NULL && self.kept_count == 0u) {
    edit(octet);
    return;
  }
  keep(octet);
  if (((octet & 0xFFu) == RETURN || (octet & 0xFFu) == LINE_FEED) && asks_to_stop()) {
    stop_at_once();
    return;
  }
  if (console_work.function == NULL || keeps_more()) return;
  line_refused(SAY_more_input_than_can_be_kept_the);
  end_job();
}

const text_port_t console_text_port = {keeps_more, take_key, give_way};

// Someone who watches the terminal wants to know why the motor stops.
static void tell(void) {
  fault_record_t fault;
  const uint16_t total = fault_history_total();
  const bool faulted = total != self.faults_shown && fault_history_read(0, &fault);
  const bool stopped = comm_watchdog_has_stopped();
  const bool silent = stopped && !self.silence_shown;
  self.faults_shown = total;
  self.silence_shown = stopped;
  if (!self.someone_types || !(faulted || silent)) return;
  octet_writer_t* const w = line_begin();
  put_text(w, "\r\n! ");
  if (faulted) {
    put_packed(w, SAY_fault);
    put_message(w, CATALOGUE_FAULT, (uint16_t)fault.fault);
  } else {
    put_packed(w, SAY_nothing_was_heard_for_link_timeout);
  }
  line_end();
  editor_show(&self.editor, line_begin());
  line_flush();
}

void console_service(void) {
  if (hal_sci_room() < ROOM) return;
  if (console_work.function != NULL) {
    if (!console_work.function(console_work.step++)) end_job();
  } else if (self.kept_count > 0u) {
    const uint16_t octet = self.kept[self.kept_first];
    self.kept_first = (uint16_t)(self.kept_first + 1u) & (KEPT - 1u);
    self.kept_count--;
    edit(octet);
  } else {
    tell();
  }
}

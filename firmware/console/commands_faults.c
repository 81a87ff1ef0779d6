// faults.

#include "firmware/console/commands.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/console/status_text.h"
#include "firmware/dictionary/units.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

static void put_fault(octet_writer_t* w, const fault_record_t* f) {
  put_unsigned(w, f->time_ms / 1000u);
  put_u8(w, '.');
  put_digits(w, f->time_ms % 1000u, 3);
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
  put_quantity(w, f->link_q16, UNIT_V, 16, 1);
  if ((f->known & KNOWN_FRAME) != 0u) {
    put_current_pair(w, SAY_v_d, f->current_d_q20, SAY_a_q, f->current_q_q20);
  } else {
    put_packed(w, SAY_volts);
  }
}

static bool list_faults(uint16_t step) {
  fault_record_t f;
  octet_writer_t* const w = line_begin();
  if (step == 0u) {
    put_count(w, fault_history_total(), SAY_since_power_on_which_was);
    put_count(w, drive_time_ms() / 1000u, SAY_s_ago_the_newest_first);
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

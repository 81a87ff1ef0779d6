// commission.

#include "firmware/commissioning/commands.h"

#include <stddef.h>

#include "firmware/commissioning/actions.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

static void show_commissioning(void) {
  const commissioning_outcome_t outcome = drive_commissioning_outcome();
  octet_writer_t* const w = line_begin();
  put_packed(w, SAY_commissioning);
  put_message(w, CATALOGUE_COMMISSIONING, (uint16_t)outcome);
  if (outcome == COMMISSIONING_RUNNING) {
    put_packed(w, SAY_comma);
    put_count(w, (uint32_t)drive_commissioning_progress() / 10u, SAY_percent_of);
    put_message(w, CATALOGUE_PHASE, (uint16_t)drive_commissioning_phase());
  }
  if (outcome == COMMISSIONING_DONE || outcome == COMMISSIONING_PARTLY) put_unsaved(w);
  line_end();
}

static bool list_results(uint16_t step) {
  const commissioning_result_t* const r = drive_commissioning_result(step);
  if (r == NULL) return false;  // there is no such result, or none any more
  const parameter_info_t* const p = parameter_by_id(r->id);
  octet_writer_t* const w = line_begin();
  put_name(w, p);
  put_spaces_to(w, 22);
  put_number(w, p, r->before);
  put_packed(w, SAY_becomes);
  put_value(w, p, r->value);
  put_spaces_to(w, 50);
  put_message(w, CATALOGUE_VERDICT, (uint16_t)r->verdict);
  line_end();
  return true;
}

static void begin_commissioning(const words_of_line_t* a) {
  comm_watchdog_t watchdog;
  if (!choose_watchdog(a, 1, &watchdog)) return;
  const bool begins = action_commission(watchdog, comm_watchdog_beside_text(), line_begin()) == ANSWER_OK;
  line_answer(begins, SAY_commissioning_the_shaft_will_turn_stop_ends);
  if (begins) say_watchdog(watchdog);
}

void command_commission(const words_of_line_t* a) {
  const bool results = word_is(a, 0, SAY_results);
  if (word_is(a, 0, TEXT_COMMAND_NAME_start)) {
    begin_commissioning(a);
  } else if (a->count != 0u && !results) {
    line_refused(SAY_commission_commission_start_or_commission_re);
  } else {
    show_commissioning();
    if (results) console_run(list_results, false);
  }
}

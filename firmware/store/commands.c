// save, load, defaults.

#include "firmware/store/commands.h"

#include <stddef.h>

#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/store/actions.h"
#include "firmware/store/store.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

static void put_report(octet_writer_t* w) {
  const store_report_t* const r = store_report();
  const parameter_info_t* const first = parameter_by_id(r->first_refused);
  if (first == NULL) return;
  put_packed(w, SAY_semicolon);
  put_count(w, r->refused, SAY_refused_now_at_their_default);
  put_packed(w, SAY_colon);
  put_name(w, first);
  if (r->refused > 1u) put_packed(w, SAY_and_more);
}

static bool wait_for_store(uint16_t step) {
  (void)step;
  if (store_is_busy()) return true;
  const store_state_t state = store_state();
  if (state != STORE_SAVED && state != STORE_LOADED && state != STORE_MIGRATED) count_refusal();
  octet_writer_t* const w = line_begin();
  put_message(w, CATALOGUE_STORE, (uint16_t)state);
  put_report(w);
  line_end();
  return false;
}

static void await(answer_status_t status) {
  if (status == ANSWER_OK) {
    console_run(wait_for_store, false);
  } else {
    line_end_refused();
  }
}

void command_save(const words_of_line_t* a) {
  (void)a;
  await(action_save(line_begin()));
}

void command_load(const words_of_line_t* a) {
  (void)a;
  await(action_load(line_begin()));
}

void command_defaults(const words_of_line_t* a) {
  (void)a;
  line_answer(action_defaults(line_begin()) == ANSWER_OK, SAY_every_parameter_is_at_its_default_save);
}

static void status_store(octet_writer_t* w) {
  put_message(w, CATALOGUE_STORE, (uint16_t)store_state());
  put_packed(w, SAY_saves_so_far);
  put_unsigned(w, store_report()->sequence);
}

const status_line_t store_line = {SAY_title_store, status_store};

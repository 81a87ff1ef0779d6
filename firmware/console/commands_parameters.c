// list, get, set.

#include <stddef.h>

#include "firmware/api/actions.h"
#include "firmware/console/commands.h"
#include "firmware/console/job.h"
#include "firmware/console/names.h"
#include "firmware/console/output.h"
#include "firmware/console/signal_text.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#define COLUMN_VALUE 23u
#define COLUMN_MEANING 42u

static void put_row(const parameter_info_t* p) {
  const int32_t raw = *parameter_in_use(p);
  octet_writer_t* const w = line_begin();
  put_name(w, p);
  put_spaces_to(w, COLUMN_VALUE - 1u);
  put_u8(w, (raw == parameter_initial(p)) ? ' ' : '*');
  put_value(w, p, raw);
  put_spaces_to(w, COLUMN_MEANING);
  put_packed(w, parameter_meaning(p));
  line_end();
}

static bool list_one(uint16_t step) {
  const parameter_info_t* const p = parameter_info(step);
  if (p == NULL) return false;
  if (filter_takes(parameter_name(p), parameter_meaning(p))) put_row(p);
  return true;
}

void command_list(const words_of_line_t* a) {
  filter_begin(a);
  console_run(list_one, false);
}

static const parameter_info_t* described;

static bool describe(uint16_t step) {
  const parameter_info_t* const p = described;
  if (p == NULL) return false;
  octet_writer_t* const w = line_begin();
  if (step == 0u) {
    put_in_use(w, p);
  } else if (step == 1u) {
    put_packed(w, SAY_indent);
    put_span(w, p);
    put_packed(w, SAY_default);
    put_number(w, p, parameter_initial(p));
    put_packed(w, SAY_number);
    put_unsigned(w, p->id);
    if (p->access == PARAMETER_STOPPED) put_packed(w, SAY_only_while_the_power_stage_is_off);
  } else {
    put_packed(w, SAY_indent);
    put_packed(w, parameter_meaning(p));
  }
  line_end();
  return step < 2u;
}

void command_get(const words_of_line_t* a) {
  if (a->count != 1u) {
    line_refused(SAY_get_name_one_parameter_or_signal);
    return;
  }
  described = parameter_named(a->word[0].text, a->word[0].count);
  if (described != NULL) {
    console_run(describe, false);
    return;
  }
  const uint16_t place = signal_find(&a->word[0]);
  if (place == SIGNAL_NONE) {
    refuse_name(NAME_PARAMETER, &a->word[0]);
    return;
  }
  put_signal_row(line_begin(), place);
  line_end();
}

static void take_value(const parameter_info_t* p, int32_t raw) {
  octet_writer_t* const w = line_begin();
  const answer_status_t status = action_set(p, raw, w);
  if (status == ANSWER_OK) {
    put_in_use(w, p);
  } else if (*parameter_in_use(p) != raw) {  // one that does not fit together with others yet is taken
    count_refusal();
  }
  line_end();
}

// As it was typed: a number that does not fit has no other form.
static void refuse_value(const parameter_info_t* p, const word_t* typed, packed_text_t why) {
  octet_writer_t* const w = line_begin();
  put_name_is(w, p);
  put_word(w, typed);
  put_packed(w, why);
  put_range(w, p);
  line_end_refused();
}

void command_set(const words_of_line_t* a) {
  decimal_t number;
  int32_t raw;
  if (a->count < 2u) {
    line_refused(SAY_set_name_value_unit_for_example_set);
    return;
  }
  const parameter_info_t* const p = parameter_named(a->word[0].text, a->word[0].count);
  if (p == NULL) {
    refuse_name(NAME_PARAMETER, &a->word[0]);
    return;
  }
  word_t typed = words_from(a, 1);
  const uint16_t length = number_with_unit(a, 1, parameter_unit(p), &number);
  if (length == 0u) {
    refuse_value(p, &typed, SAY_is_not_a_number_in);
    return;
  }
  typed.count = length;
  if (!decimal_raw(&number, parameter_q(p), &raw) || !parameter_allows(p, raw)) {
    refuse_value(p, &typed, SAY_is_outside_of);
  } else if (p->q == 0u && !decimal_is_whole(&number)) {
    refuse_value(p, &typed, SAY_is_not_a_whole_number_in);
  } else {
    take_value(p, raw);
  }
}

#include "firmware/console/names.h"

#include <stddef.h>

#include "firmware/base/edition.h"
#include "firmware/console/command_table.h"
#include "firmware/console/output.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

const packed_text_t first_names[] = {TEXT_PARAMETER_NAME_pole_pairs, TEXT_SIGNAL_NAME_state, TEXT_COMMAND_NAME_help,
                                     PACKED_TEXTS};

bool name_is_here(packed_text_t name) {
  if (name >= first_names[NAME_COMMAND]) return command_is_here((uint16_t)(name - first_names[NAME_COMMAND]));
  if (name >= first_names[NAME_SIGNAL]) {
    return !rows_have(edition_signals_left_out, (uint16_t)(name - first_names[NAME_SIGNAL]));
  }
  return !rows_have(edition_parameters_left_out, (uint16_t)(name - first_names[NAME_PARAMETER]));
}

// Whether another edition has one of that kind.
static bool is_left_out(name_kind_t kind, const word_t* word) {
  const packed_text_t first = first_names[kind], end = first_names[kind + 1];
  const packed_text_t name =
      (packed_text_t)(first + packed_find(first, (uint16_t)(end - first), word->text, word->count));
  return name < end && !name_is_here(name);
}

static void refuse_left_out(const word_t* word) {
  octet_writer_t* const w = line_begin();
  put_u8(w, '\'');
  put_word(w, word);
  put_packed(w, SAY_is_not_in_this_edition);
  put_text(w, edition_name);
  put_packed(w, SAY_see_editions_in_the_book);
  line_end_refused();
}

octet_writer_t* put_no_such_name(name_kind_t kind, const word_t* word) {
  octet_writer_t* const w = line_begin();
  put_packed(w, (packed_text_t)(SAY_there_is_no_parameter + (uint16_t)kind));
  put_word(w, word);
  return w;
}

void say_no_such_name(name_kind_t kind, const word_t* word) {
  put_packed(put_no_such_name(kind, word), (packed_text_t)(SAY_see_list + (uint16_t)kind));
  line_end_refused();
}

void refuse_name(name_kind_t kind, const word_t* word) {
  const bool is_command = kind == NAME_COMMAND;  // otherwise a parameter or a signal may be meant
  if (is_left_out(is_command ? kind : NAME_PARAMETER, word) || (!is_command && is_left_out(NAME_SIGNAL, word))) {
    refuse_left_out(word);
  } else if (edition_suggest != NULL) {
    edition_suggest(kind, word);
  } else {
    say_no_such_name(kind, word);
  }
}

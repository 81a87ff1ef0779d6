// The line editor with any octet, from every line, cursor and history that there can be; each length of the line by
// itself. It leads to such a line again: so it holds octet after octet without end.

#include "firmware/console/editor.h"

#include "tests/prove/any.h"

static editor_t e;
static uint16_t block[200];  // TEXT_LINE_MAX without its end

static void any_text(editor_line_t* line) {
  for (uint16_t k = 0; k < EDITOR_LINE; k++) line->text[k] = any_u16;
}

static void any_state(uint16_t count) {
  e.line.count = count;
  for (uint16_t k = 0; k < EDITOR_HISTORY; k++) e.history[k].count = (uint16_t)any_from(0, (int32_t)EDITOR_LINE);
  e.cursor = any_u16;
  e.too_long = any_bool();
  e.disturbed = any_bool();
  e.expired = any_bool();
  e.cut = any_bool();
  e.after_return = any_bool();
  e.escape = (uint16_t)any_from(0, 2);
  e.parameter = any_u16;
  e.recalled = (uint16_t)any_from(0, (int32_t)EDITOR_HISTORY);
}

void prove_editor(void) {
  editor_reset(&e);
  any_text(&e.line);
  for (uint16_t k = 0; k < EDITOR_HISTORY; k++) {
    for (uint16_t j = 0; j < EDITOR_LINE / 2u; j++) e.history[k].pairs[j] = any_u16;
  }
  //@ loop unroll 81;
  for (uint16_t count = 0; count <= EDITOR_LINE; count++) {
    octet_writer_t echo = octet_writer(block, 200);
    any_state(count);
    (void)editor_octet(&e, any_u16, &echo);
    any_state(count);
    editor_next(&e);
    any_state(count);
    editor_cut(&e, any_bool());
    any_state(count);
    echo = octet_writer(block, 200);
    editor_show(&e, &echo);
  }
}

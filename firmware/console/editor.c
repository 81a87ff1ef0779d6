#include "firmware/console/editor.h"

#include "hal/qmath/qmath.h"

#define BELL 0x07u
#define BACKSPACE 0x08u
#define LINE_FEED 0x0Au
#define RETURN 0x0Du
#define CTRL_A 0x01u
#define CTRL_C 0x03u
#define CTRL_E 0x05u
#define CTRL_U 0x15u
#define ESCAPE 0x1Bu
#define DELETE 0x7Fu

enum { ESCAPE_NONE = 0, ESCAPE_BEGUN, ESCAPE_SEQUENCE };

static void begin_line(editor_t* e) {
  e->line.count = 0;
  e->cursor = 0;
  e->too_long = false;
  e->disturbed = false;
  e->expired = false;
  e->cut = false;
  e->escape = ESCAPE_NONE;
  e->recalled = 0;
}

void editor_reset(editor_t* e) {
  begin_line(e);
  e->after_return = false;
  e->parameter = 0;
  for (uint16_t k = 0; k < EDITOR_HISTORY; k++) e->history[k].count = 0;
}

void editor_cut(editor_t* e, bool more) {
  const bool cut = e->cut || more || e->line.count > 0u;
  begin_line(e);
  e->cut = cut;
}

void editor_show(const editor_t* e, octet_writer_t* echo) {
  put_u8(echo, RETURN);
  put_text(echo, EDITOR_PROMPT);
  for (uint16_t k = 0; k < e->line.count; k++) put_u8(echo, e->line.text[k]);
  put_text(echo, "\x1B[K");
  for (uint16_t k = e->cursor; k < e->line.count; k++) put_u8(echo, BACKSPACE);
}

static void insert(editor_t* e, uint16_t c, octet_writer_t* echo) {
  editor_line_t* const l = &e->line;
  if (l->count >= EDITOR_LINE) {
    e->too_long = true;
    put_u8(echo, BELL);
    return;
  }
  for (uint16_t k = l->count; k > e->cursor; k--) l->text[k] = l->text[k - 1u];
  l->text[e->cursor++] = c;
  l->count++;
  if (e->cursor == l->count) {
    put_u8(echo, c);
  } else {
    editor_show(e, echo);
  }
}

// Removes the character under the cursor.
static void remove_here(editor_t* e) {
  if (e->cursor >= e->line.count) return;
  e->line.count--;
  for (uint16_t k = e->cursor; k < e->line.count; k++) e->line.text[k] = e->line.text[k + 1u];
}

static void backspace(editor_t* e, octet_writer_t* echo) {
  if (e->cursor == 0u) return;
  e->cursor--;
  remove_here(e);
  if (e->cursor == e->line.count) {
    put_text(echo, "\b \b");
  } else {
    editor_show(e, echo);
  }
}

static uint16_t packed_at(const editor_packed_t* p, uint16_t k) {
  return (p->pairs[k / 2u] >> (8u * (k % 2u))) & 0xFFu;
}

static void unpack(editor_line_t* line, const editor_packed_t* p) {
  line->count = p->count;
  for (uint16_t k = 0; k < p->count; k++) line->text[k] = packed_at(p, k);
}

// What is beyond the end of the line makes no difference.
static void pack(editor_packed_t* p, const editor_line_t* line) {
  p->count = line->count;
  for (uint16_t k = 0; k < line->count; k += 2u) p->pairs[k / 2u] = (uint16_t)(line->text[k] | line->text[k + 1u] << 8);
}

static void recall(editor_t* e, uint16_t which) {
  if (which > EDITOR_HISTORY || (which > 0u && e->history[which - 1u].count == 0u)) return;
  e->recalled = which;
  if (which == 0u) {
    e->line.count = 0;
  } else {
    unpack(&e->line, &e->history[which - 1u]);
  }
  e->cursor = e->line.count;
}

// The end of an escape sequence: the key that it stands for.
static void key(editor_t* e, uint16_t final) {
  switch (final) {
    case 'A':
      recall(e, (uint16_t)(e->recalled + 1u));
      break;
    case 'B':
      if (e->recalled > 0u) recall(e, (uint16_t)(e->recalled - 1u));
      break;
    case 'C':
      if (e->cursor < e->line.count) e->cursor++;
      break;
    case 'D':
      if (e->cursor > 0u) e->cursor--;
      break;
    case 'H':
      e->cursor = 0;
      break;
    case 'F':
      e->cursor = e->line.count;
      break;
    case '~':
      if (e->parameter == 3u) remove_here(e);
      break;
    default:
      break;
  }
}

// ESC [ parameters final, or ESC O final: printable characters.
static void escape(editor_t* e, uint16_t octet, octet_writer_t* echo) {
  if (e->escape == ESCAPE_BEGUN) {
    e->escape = (octet == '[' || octet == 'O') ? ESCAPE_SEQUENCE : ESCAPE_NONE;
    e->parameter = 0;
    return;
  }
  if (octet >= '0' && octet <= '9') {
    e->parameter = (uint16_t)(octet - '0');
    return;
  }
  if (octet < 0x40u) return;
  e->escape = ESCAPE_NONE;
  key(e, octet);
  editor_show(e, echo);
}

static editor_event_t finish(editor_t* e, uint16_t octet, octet_writer_t* echo) {
  if (octet == LINE_FEED && e->after_return) {
    e->after_return = false;
    return EDITOR_NOTHING;
  }
  e->after_return = octet == RETURN;
  put_text(echo, "\r\n");
  return EDITOR_DONE;
}

static editor_event_t control(editor_t* e, uint16_t octet, octet_writer_t* echo) {
  switch (octet) {
    case BACKSPACE:
    case DELETE:
      backspace(e, echo);
      break;
    case CTRL_C:
    case CTRL_U:
      begin_line(e);
      if (octet == CTRL_C) {
        put_text(echo, "^C\r\n");
        return EDITOR_BREAK;
      }
      editor_show(e, echo);
      break;
    case CTRL_A:
    case CTRL_E:
      key(e, (octet == CTRL_A) ? 'H' : 'F');
      editor_show(e, echo);
      break;
    case ESCAPE:
      e->escape = ESCAPE_BEGUN;
      break;
    default:
      break;
  }
  return EDITOR_NOTHING;
}

editor_event_t editor_octet(editor_t* e, uint16_t octet, octet_writer_t* echo) {
  octet &= 0xFFu;
  e->cursor = (uint16_t)q_min(e->cursor, e->line.count);
  if (octet == RETURN || octet == LINE_FEED) return finish(e, octet, echo);
  e->after_return = false;
  const bool printable = octet >= 0x20u && octet < DELETE;
  if (e->escape != ESCAPE_NONE && printable) {
    escape(e, octet, echo);
  } else if (printable) {
    insert(e, octet, echo);
  } else if (octet > DELETE) {
    e->disturbed = e->disturbed || e->line.count > 0u;
  } else {
    e->escape = ESCAPE_NONE;
    return control(e, octet, echo);
  }
  return EDITOR_NOTHING;
}

static bool is_same(const editor_line_t* line, const editor_packed_t* p) {
  if (line->count != p->count) return false;
  for (uint16_t k = 0; k < line->count; k++) {
    if (line->text[k] != packed_at(p, k)) return false;
  }
  return true;
}

void editor_next(editor_t* e) {
  const bool worth_it = e->line.count > 0u && !e->too_long && !is_same(&e->line, &e->history[0]);
  if (worth_it) {
    for (uint16_t k = EDITOR_HISTORY - 1u; k > 0u; k--) e->history[k] = e->history[k - 1u];
    pack(&e->history[0], &e->line);
  }
  begin_line(e);
}

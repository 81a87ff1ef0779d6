// A line of text on its way in: what a terminal sends, and what it has to be sent back.
//
// Characters are inserted at the cursor. Backspace and Delete, Ctrl-U (clears the line), Ctrl-C, the arrows left and
// right, Home and End move and change it; the arrows up and down bring back the last lines. CR, LF or both end it. All
// other control characters and whatever is not ASCII are ignored. A line that is too long, or within which something
// was not ASCII, is marked: what stands in it is not what was sent.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_EDITOR_H
#define STILLSPIN_FIRMWARE_CONSOLE_EDITOR_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define EDITOR_LINE 80u
#define EDITOR_HISTORY 4u
#define EDITOR_ECHO_MAX 176u  // characters that one octet can send back
#define EDITOR_PROMPT "> "

typedef struct {
  uint16_t text[EDITOR_LINE];
  uint16_t count;
} editor_line_t;

/// A line that is kept, two characters in a word.
typedef struct {
  uint16_t pairs[EDITOR_LINE / 2u];
  uint16_t count;
} editor_packed_t;

typedef struct {
  editor_line_t line;
  uint16_t cursor;
  bool too_long;
  bool disturbed;
  bool expired;       // it has stood for long; set from outside
  bool cut;           // it may have begun before it was emptied
  bool after_return;  // a LF that follows belongs to it
  uint16_t escape;    // where in an escape sequence
  uint16_t parameter;
  uint16_t recalled;                        // 0: the line itself, k: history[k - 1]
  editor_packed_t history[EDITOR_HISTORY];  // [0] is the newest
} editor_t;

typedef enum { EDITOR_NOTHING, EDITOR_DONE, EDITOR_BREAK } editor_event_t;

void editor_reset(editor_t* e);

/// An empty line, with the history as it is. What comes next may be the rest of what was there, or of what was typed
/// behind it (`more`).
void editor_cut(editor_t* e, bool more);

/// Takes an octet and appends to `echo` what the terminal is to be sent. After EDITOR_DONE the line is in `line` until
/// editor_next.
editor_event_t editor_octet(editor_t* e, uint16_t octet, octet_writer_t* echo);

/// Notes the line in the history and begins the next one.
void editor_next(editor_t* e);

/// Prompt and line as they stand, for a terminal that has been written to meanwhile.
void editor_show(const editor_t* e, octet_writer_t* echo);

#if defined(__cplusplus)
}
#endif

#endif

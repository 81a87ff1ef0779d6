// scope: its sub-commands.

#include "firmware/scope/commands.h"

#include "firmware/console/output.h"
#include "firmware/scope/scope.h"
#include "firmware/scope/sub_commands.h"
#include "firmware/text/packed_text.h"

// Everything but the channels has been looked at where it was read.
static void say(bool done, packed_text_t what) {
  if (done) {
    line_of(what);
  } else {
    line_refused(SAY_first_scope_channels_signal);
  }
}

static bool arm(const words_of_line_t* a, scope_setup_t* s) {
  (void)a;
  (void)s;
  say(scope_arm(), SAY_armed);
  return false;
}

static bool stop(const words_of_line_t* a, scope_setup_t* s) {
  (void)a;
  (void)s;
  scope_stop();
  line_of(SAY_stopped);
  return false;
}

static const struct {
  packed_text_t word;
  bool (*obey)(const words_of_line_t* a, scope_setup_t* s);
} sub_commands[] = {{SAY_channels, scope_set_channels},
                    {SAY_sub_trigger, scope_set_trigger},
                    {SAY_hysteresis, scope_set_hysteresis},
                    {SAY_sub_every, scope_set_every},
                    {SAY_sub_before, scope_set_before},
                    {SAY_sub_mode, scope_set_mode},
                    {SAY_sub_arm, arm},
                    {TEXT_COMMAND_NAME_stop, stop},
                    {SAY_sub_print, scope_print}};

static scope_setup_t draft(void) {
  scope_setup_t s = *scope_setup_in_force();
  if (s.count > 0u) return s;
  s.decimation = 1;
  s.pretrigger = SCOPE_DEPTH / 4u;
  s.mode = SCOPE_SINGLE;
  s.edge = SCOPE_AT_ONCE;
  s.hysteresis = SCOPE_BY_SPAN;
  return s;
}

void command_scope(const words_of_line_t* a) {
  if (a->count == 0u) {
    scope_show();
    return;
  }
  for (uint16_t k = 0; k < sizeof sub_commands / sizeof sub_commands[0]; k++) {
    if (!word_is(a, 0, sub_commands[k].word)) continue;
    scope_setup_t s = draft();
    if (sub_commands[k].obey(a, &s)) say(scope_setup(&s), SAY_set_scope_arm_starts_it);
    return;
  }
  line_refused(SAY_no_such_scope_command_see_help);
}

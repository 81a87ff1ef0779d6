// scope: its sub-commands.

#include "firmware/scope/commands.h"

#include "firmware/console/output.h"
#include "firmware/scope/scope.h"
#include "firmware/scope/sub_commands.h"
#include "firmware/text/packed_text.h"

static void arm(const words_of_line_t* a) {
  (void)a;
  if (scope_arm()) {
    line_of(SAY_armed);
  } else {
    line_refused(SAY_first_scope_channels_signal);
  }
}

static void stop(const words_of_line_t* a) {
  (void)a;
  scope_stop();
  line_of(SAY_stopped);
}

static const struct {
  packed_text_t word;
  void (*obey)(const words_of_line_t* a);
} sub_commands[] = {{SAY_channels, scope_set_channels}, {SAY_sub_trigger, scope_set_trigger},
                    {SAY_sub_every, scope_set_every},   {SAY_sub_before, scope_set_before},
                    {SAY_sub_mode, scope_set_mode},     {SAY_sub_arm, arm},
                    {TEXT_COMMAND_NAME_stop, stop},     {SAY_sub_print, scope_print}};

void command_scope(const words_of_line_t* a) {
  if (a->count == 0u) {
    scope_show();
    return;
  }
  for (uint16_t k = 0; k < sizeof sub_commands / sizeof sub_commands[0]; k++) {
    if (!word_is(a, 0, sub_commands[k].word)) continue;
    sub_commands[k].obey(a);
    return;
  }
  line_refused(SAY_no_such_scope_command_see_help);
}

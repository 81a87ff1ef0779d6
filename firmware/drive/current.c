// Current control, every period or every second one (current_divider).

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

void drive_control_current(const drive_t* d, drive_control_t* c) {
  if (!c->references.closed || d->modulation.sliced != 0u) {
    const dq_t none = {0, 0};
    c->command_q16 = none;
    current_controller_reset(&c->current);
    return;
  }
  // In between, the command stands still in the rotor frame. The divider is 1 or 2.
  if ((d->schedule.period & (uint16_t)(d->config.values.current_divider - 1)) != 0u) return;
  c->command_q16 =
      current_controller_step(&c->current, &d->config.current, &d->estimate.model, c->references.current_q20,
                              d->estimate.measured_q20, d->estimate.selected.speed_bpp);
  if (c->references.feed_forward_q16 != 0)
    c->command_q16.q = q_limit(q_add_sat(c->command_q16.q, c->references.feed_forward_q16), CURRENT_COMMAND_END_Q16);
}

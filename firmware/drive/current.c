// Current control, every period or every second one (current_divider).

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

void drive_control_current(const drive_t* d, current_controller_t* controller, dq_t* command_q16) {
  const drive_control_t* const c = &d->control;
  if (!c->references.closed || d->sliced != 0u) {
    const dq_t none = {0, 0};
    *command_q16 = none;
    current_controller_reset(controller);
    return;
  }
  // In between, the command stands still in the rotor frame. The divider is 1 or 2.
  if ((d->schedule.period & (uint16_t)(d->config.values.current_divider - 1)) != 0u) return;
  *command_q16 = current_controller_step(controller, &d->config.current, &d->model, c->references.current_q20,
                                         c->measured_q20, d->position.selected.speed_bpp);
  if (c->references.feed_forward_q16 != 0)
    command_q16->q = q_limit(q_add_sat(command_q16->q, c->references.feed_forward_q16), CURRENT_COMMAND_END_Q16);
}

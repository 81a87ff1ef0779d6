#include "firmware/can/telemetry.h"

#include "firmware/can/messages.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"

void telemetry_status(hal_can_frame_t* frame, const can_command_t* command, uint16_t alive) {
  const drive_signals_t s = drive_signals();
  const int32_t values[] = {s.state,
                            command->commanding ? 1 : 0,
                            command->timed_out ? 1 : 0,
                            drive_is_energised() ? 1 : 0,
                            s.speed_known,
                            s.fault,
                            s.limit,
                            alive,
                            can_steps(CAN_STATUS_SPEED, s.speed, 16),
                            can_steps(CAN_STATUS_REFERENCE, s.speed_reference, 16)};
  can_put_all(frame, CAN_STATUS_STATE, values, sizeof values / sizeof values[0]);
}

// What the fields of both messages have, in their order.
static const uint16_t sent[] = {SIGNAL_PLACE(current_d),           SIGNAL_PLACE(current_q),
                                SIGNAL_PLACE(link_voltage),        SIGNAL_PLACE(load_torque),
                                SIGNAL_PLACE(current_d_reference), SIGNAL_PLACE(current_q_reference),
                                SIGNAL_PLACE(voltage_d),           SIGNAL_PLACE(voltage_q)};

#define VALUES (sizeof sent / sizeof sent[0])

// The second message's fields are behind those of the first.
typedef char fields_are_in_a_row[(CAN_TELEMETRY_2_VOLTAGE_Q == CAN_TELEMETRY_1_CURRENT_D + (int)VALUES - 1) ? 1 : -1];

void telemetry_values(hal_can_frame_t* first, hal_can_frame_t* second) {
  int32_t values[VALUES];
  (void)drive_signals_copy(sent, VALUES, values);
  for (uint16_t k = 0; k < VALUES; k++) {
    const can_field_t field = (can_field_t)(CAN_TELEMETRY_1_CURRENT_D + k);
    values[k] = can_steps(field, values[k], signal_info(sent[k])->q);
  }
  can_put_all(first, CAN_TELEMETRY_1_CURRENT_D, values, VALUES / 2u);
  can_put_all(second, CAN_TELEMETRY_2_CURRENT_D_REFERENCE, &values[VALUES / 2u], VALUES / 2u);
}

#include "firmware/can/telemetry.h"

#include "firmware/can/messages.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"

// A value with q fractional bits in steps of its field.
static void put_steps(hal_can_frame_t* frame, can_field_t field, int32_t value, uint16_t q) {
  can_put(frame, field, can_steps(field, value, q));
}

void telemetry_status(hal_can_frame_t* frame, const can_command_t* command, uint16_t alive) {
  const drive_signals_t s = drive_signals();
  can_put(frame, CAN_STATUS_STATE, s.state);
  can_put(frame, CAN_STATUS_COMMANDED, command->commanding ? 1 : 0);
  can_put(frame, CAN_STATUS_TIMED_OUT, command->timed_out ? 1 : 0);
  can_put(frame, CAN_STATUS_ENERGISED, drive_is_energised() ? 1 : 0);
  can_put(frame, CAN_STATUS_SPEED_KNOWN, s.speed_known);
  can_put(frame, CAN_STATUS_FAULT, s.fault);
  can_put(frame, CAN_STATUS_LIMITS, s.limit);
  can_put(frame, CAN_STATUS_ALIVE, (int32_t)alive);
  put_steps(frame, CAN_STATUS_SPEED, s.speed, 16);
  put_steps(frame, CAN_STATUS_REFERENCE, s.speed_reference, 16);
}

void telemetry_values(hal_can_frame_t* first, hal_can_frame_t* second) {
  const drive_signals_t s = drive_signals();
  put_steps(first, CAN_TELEMETRY_1_CURRENT_D, s.current_d, 20);
  put_steps(first, CAN_TELEMETRY_1_CURRENT_Q, s.current_q, 20);
  put_steps(first, CAN_TELEMETRY_1_LINK_VOLTAGE, s.link_voltage, 16);
  put_steps(first, CAN_TELEMETRY_1_LOAD_TORQUE, s.load_torque, 16);
  put_steps(second, CAN_TELEMETRY_2_CURRENT_D_REFERENCE, s.current_d_reference, 20);
  put_steps(second, CAN_TELEMETRY_2_CURRENT_Q_REFERENCE, s.current_q_reference, 20);
  put_steps(second, CAN_TELEMETRY_2_VOLTAGE_D, s.voltage_d, 16);
  put_steps(second, CAN_TELEMETRY_2_VOLTAGE_Q, s.voltage_q, 16);
}

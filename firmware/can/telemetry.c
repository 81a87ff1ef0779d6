#include "firmware/can/telemetry.h"

#include "firmware/can/messages.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"

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
  can_put(frame, CAN_STATUS_SPEED, can_steps(CAN_STATUS_SPEED, s.speed, 16u));
  can_put(frame, CAN_STATUS_REFERENCE, can_steps(CAN_STATUS_REFERENCE, s.speed_reference, 16u));
}

void telemetry_values(hal_can_frame_t* first, hal_can_frame_t* second) {
  const drive_signals_t s = drive_signals();
  can_put(first, CAN_TELEMETRY_1_CURRENT_D, can_steps(CAN_TELEMETRY_1_CURRENT_D, s.current_d, 20u));
  can_put(first, CAN_TELEMETRY_1_CURRENT_Q, can_steps(CAN_TELEMETRY_1_CURRENT_Q, s.current_q, 20u));
  can_put(first, CAN_TELEMETRY_1_LINK_VOLTAGE, can_steps(CAN_TELEMETRY_1_LINK_VOLTAGE, s.link_voltage, 16u));
  can_put(first, CAN_TELEMETRY_1_LOAD_TORQUE, can_steps(CAN_TELEMETRY_1_LOAD_TORQUE, s.load_torque, 16u));
  can_put(second, CAN_TELEMETRY_2_CURRENT_D_REFERENCE,
          can_steps(CAN_TELEMETRY_2_CURRENT_D_REFERENCE, s.current_d_reference, 20u));
  can_put(second, CAN_TELEMETRY_2_CURRENT_Q_REFERENCE,
          can_steps(CAN_TELEMETRY_2_CURRENT_Q_REFERENCE, s.current_q_reference, 20u));
  can_put(second, CAN_TELEMETRY_2_VOLTAGE_D, can_steps(CAN_TELEMETRY_2_VOLTAGE_D, s.voltage_d, 16u));
  can_put(second, CAN_TELEMETRY_2_VOLTAGE_Q, can_steps(CAN_TELEMETRY_2_VOLTAGE_Q, s.voltage_q, 16u));
}

// Status and telemetry: every field says what its signal says, in the unit of the message list.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/can/messages.h"
#include "firmware/can/telemetry.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {
namespace {

class CanTelemetry : public Drive {
 protected:
  void SetUp() override {
    NEEDS("can");
    Drive::SetUp();
  }
  can_command_t command = {};

  /// As the other end reads it, in units.
  static double value_of(const hal_can_frame_t& frame, can_field_t field) {
    return can_get(&frame, field) / double(can_field_info(field)->per_unit);
  }
  static double half_step(can_field_t field) { return 0.5 / can_field_info(field)->per_unit; }

  hal_can_frame_t status(std::uint16_t alive = 0) const {
    hal_can_frame_t frame = can_frame(CAN_STATUS, 1);
    telemetry_status(&frame, &command, alive);
    return frame;
  }
  /// The fields of STATUS in which two frames differ.
  static std::vector<can_field_t> changed(const hal_can_frame_t& a, const hal_can_frame_t& b) {
    std::vector<can_field_t> fields;
    for (std::uint16_t k = 0; k < CAN_FIELDS; ++k) {
      const auto field = static_cast<can_field_t>(k);
      if (can_field_info(k)->message == CAN_STATUS && can_get(&a, field) != can_get(&b, field)) fields.push_back(field);
    }
    return fields;
  }
};

using Fields = std::vector<can_field_t>;

TEST_F(CanTelemetry, EachBitOfTheStatusHasAMeaningOfItsOwn) {
  inside::be_in(DRIVE_READY);
  const hal_can_frame_t idle = status();
  EXPECT_EQ(can_get(&idle, CAN_STATUS_STATE), DRIVE_READY);
  command.commanding = true;
  EXPECT_EQ(changed(idle, status()), Fields{CAN_STATUS_COMMANDED});
  command.commanding = false;
  command.timed_out = true;
  EXPECT_EQ(changed(idle, status()), Fields{CAN_STATUS_TIMED_OUT});
  command.timed_out = false;
  EXPECT_EQ(changed(idle, status(9)), Fields{CAN_STATUS_ALIVE});
  inside::be_in(DRIVE_STOP);
  EXPECT_EQ(changed(idle, status()), (Fields{CAN_STATUS_STATE, CAN_STATUS_ENERGISED, CAN_STATUS_SPEED_KNOWN}));
  inside::be_in(DRIVE_FAULT);
  inside::fault() = FAULT_OVER_CURRENT;
  EXPECT_EQ(changed(idle, status()), (Fields{CAN_STATUS_STATE, CAN_STATUS_FAULT}));
}

TEST_F(CanTelemetry, TheStatusNamesStateFaultAndLimits) {
  for (int state = DRIVE_BOOT; state <= DRIVE_COMMISSION; ++state) {
    inside::be_in(static_cast<drive_state_t>(state));
    const hal_can_frame_t frame = status();
    EXPECT_EQ(can_get(&frame, CAN_STATUS_STATE), state);
    EXPECT_EQ(can_get(&frame, CAN_STATUS_ENERGISED), drive_is_energised() ? 1 : 0);
    EXPECT_EQ(can_get(&frame, CAN_STATUS_SPEED_KNOWN), (drive_known(&drive) & KNOWN_ROTOR) != 0 ? 1 : 0);
  }
  inside::fault() = FAULT_OVER_CURRENT;
  inside::limits() = LIMIT_CURRENT | LIMIT_BRAKING;
  const hal_can_frame_t frame = status(13);
  EXPECT_EQ(can_get(&frame, CAN_STATUS_FAULT), FAULT_OVER_CURRENT);
  EXPECT_EQ(can_get(&frame, CAN_STATUS_LIMITS), LIMIT_CURRENT | LIMIT_BRAKING);
  EXPECT_EQ(can_get(&frame, CAN_STATUS_ALIVE), 13);
}

TEST_F(CanTelemetry, SpeedsAreInRevolutionsPerMinute) {
  inside::be_in(DRIVE_RUN);
  inside::selected().speed_bpp = bpp_of(1500);
  inside::ramped_bpp() = bpp_of(-750);
  const hal_can_frame_t frame = status();
  EXPECT_NEAR(value_of(frame, CAN_STATUS_SPEED), 1500.0, half_step(CAN_STATUS_SPEED));
  EXPECT_NEAR(value_of(frame, CAN_STATUS_REFERENCE), -750.0, half_step(CAN_STATUS_REFERENCE));
}

// Every value another one, so that none can stand for its neighbour.
TEST_F(CanTelemetry, CurrentsVoltagesAndTorqueAreInTheirUnits) {
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {raw(-1.5, 20), raw(7.25, 20)};
  inside::reference_dq_q20() = {raw(-2.125, 20), raw(9.75, 20)};
  inside::command_dq_q16() = {raw(-80.5, 16), raw(120.25, 16)};
  inside::link_q16() = raw(310.5, 16);
  inside::selected().load_accel_q8 = 1'000'000;
  const double torque = drive_signals().load_torque / 65536.0;
  ASSERT_GT(torque, 0.01);
  hal_can_frame_t first = can_frame(CAN_TELEMETRY_1, 1), second = can_frame(CAN_TELEMETRY_2, 1);
  telemetry_values(&first, &second);
  const auto expect = [](const hal_can_frame_t& frame, can_field_t field, double value) {
    EXPECT_NEAR(value_of(frame, field), value, half_step(field)) << "field " << field;
  };
  expect(first, CAN_TELEMETRY_1_CURRENT_D, -1.5);
  expect(first, CAN_TELEMETRY_1_CURRENT_Q, 7.25);
  expect(first, CAN_TELEMETRY_1_LINK_VOLTAGE, 310.5);
  expect(first, CAN_TELEMETRY_1_LOAD_TORQUE, torque);
  expect(second, CAN_TELEMETRY_2_CURRENT_D_REFERENCE, -2.125);
  expect(second, CAN_TELEMETRY_2_CURRENT_Q_REFERENCE, 9.75);
  expect(second, CAN_TELEMETRY_2_VOLTAGE_D, -80.5);
  expect(second, CAN_TELEMETRY_2_VOLTAGE_Q, 120.25);
}

}  // namespace
}  // namespace stillspin::test

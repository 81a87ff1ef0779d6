// A drive after power-on, or after a computer has stepped it: nothing of what was is left.

#include <cstring>

#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/states.h"
#include "tests/firmware/fake_hal.hpp"

namespace stillspin::test {
namespace {

TEST_F(Drive, AResetLeavesADriveThatCanStart) {
  make_run();
  const std::int32_t limit = parameters.current_limit;
  parameters.current_limit = limit / 2;
  parameters.magnet_flux = raw(0.05, 28);
  inside::sensor_trim() = {};
  inside::model().emf_q16 = inside::config().nameplate.emf_q16 / 2;
  inside::speed_ready() = inside::config_valid() = false;
  inside::current_limit_q20() = 0;
  interlock_share_q15 = 100;
  ::board.relay = true;
  selftest.failed = 1;
  drive_trip(&drive, FAULT_LINK_LOW);

  drive_reset();
  EXPECT_EQ(inside::state(), DRIVE_BOOT);
  EXPECT_EQ(inside::fault(), FAULT_NONE);
  EXPECT_EQ(inside::time_ms(), 0u);
  EXPECT_EQ(fault_history_total(), 0);
  EXPECT_EQ(selftest.failed, 0);
  EXPECT_FALSE(::board.relay);
  EXPECT_EQ(parameters.current_limit, limit) << "the values are the table's";
  EXPECT_EQ(inside::current_limit_q20(), parameters.current_limit);
  EXPECT_TRUE(inside::config_valid() && inside::speed_ready());
  for (const std::int32_t middle : {inside::zero_current_a_q8(), inside::zero_current_b_q8(),
                                    inside::sensor_trim().offset_a_q8, inside::sensor_trim().offset_b_q8}) {
    EXPECT_EQ(middle, 2048 * 256);
  }
  const slopes_scale_t scale = slopes_scale(&inside::config().slopes, &inside::sensor_trim());
  EXPECT_EQ(std::memcmp(&inside::sensor_scale(), &scale, sizeof scale), 0);
  const Motor motor;
  EXPECT_NEAR(real(inside::model().emf_q16, 16), motor.flux / kPeriod, 1.0);
  const std::int32_t per_nm_q20 = q_over(1 << 20, inside::per_torque_constant(), 24);
  EXPECT_NEAR(real(per_nm_q20, 20), 1.0 / motor.torque_constant(), 1e-3);
  EXPECT_EQ(inside::selected().angle_bam, 0u);
  EXPECT_EQ(inside::selected().speed_bpp, 0);
}

TEST_F(Drive, AResetForgetsWhatTheLastStartHasSeenOfTheWires) {
  inside::wiring() = 3;
  drive_reset();
  EXPECT_EQ(inside::wiring(), 0);
}

}  // namespace
}  // namespace stillspin::test

// The frame of the control interrupt: what it tells the model of the chip, and what stands between begin and end.

#include "firmware/interfaces/isr_cycles.h"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/scope/scope.h"
}

namespace {

using namespace stillspin::test;

using Steps = std::vector<std::uint16_t>;

class ControlInterrupt : public Drive {
 protected:
  Steps told(int missing) {
    board.profile.clear();
    period(still_window(), missing);
    return board.profile;
  }
};

// Each step says how long it takes when it has been done, so that what follows it happens as late as on the chip.
TEST_F(ControlInterrupt, EveryStepTellsItsTimeOnce) {
  make_run();
  const int windows = inside::sampled_pattern().window_count;
  Steps expected(static_cast<std::size_t>(windows), CYCLES_WINDOW);
  for (const unsigned cycles :
       {CYCLES_READ_SAMPLES, CYCLES_ESTIMATE, CYCLES_SUPERVISE, CYCLES_CONTROL, CYCLES_MODULATE, CYCLES_SERIAL}) {
    expected.push_back(static_cast<std::uint16_t>(cycles));
  }
  EXPECT_EQ(told(0), expected);
  const Steps blind = {
      CYCLES_READ_SLICES, CYCLES_ESTIMATE_NO_WINDOWS, CYCLES_SUPERVISE_NO_WINDOWS, CYCLES_CONTROL, CYCLES_MODULATE,
      CYCLES_SERIAL};
  EXPECT_EQ(told(inside::sampled_pattern().window_count), blind) << "without windows it is over earlier";
}

// The window interrupt may come between begin and end only; all of the interrupt's work is there, the serial port's
// too.
TEST_F(ControlInterrupt, ItsWorkIsBetweenBeginAndEnd) {
  const int services = board.serial_services;
  periods(5);
  EXPECT_EQ(board.control_begins, 5);
  EXPECT_EQ(board.control_ends, 5);
  EXPECT_EQ(board.serial_services, services + 5);
  EXPECT_EQ(board.outside_control, 0);
}

// Between the speed control's milliseconds the current loop makes a voltage of what is asked for.
TEST_F(ControlInterrupt, ACurrentThatIsAskedForBecomesAVoltage) {
  make_run();
  periods_until([] { return inside::scheduled_period() == 2; });
  for (const double amps : {3.0, -3.0}) {
    inside::reference_dq_q20().q = raw(amps, 20);
    const std::int32_t before = inside::command_dq_q16().q;
    periods(2);  // with a current divider of two
    EXPECT_GT((inside::command_dq_q16().q - before) * (amps > 0.0 ? 1.0 : -1.0), raw(5.0, 16)) << amps;
  }
}

TEST_F(ControlInterrupt, TheScopeSeesEachPeriod) {
  scope_setup_t s = {};
  s.count = 1;
  s.decimation = 1;
  s.edge = SCOPE_AT_ONCE;
  ASSERT_TRUE(scope_setup(&s));
  ASSERT_TRUE(scope_arm());
  periods(5);
  EXPECT_EQ(scope_status().recorded, 5);
}

}  // namespace

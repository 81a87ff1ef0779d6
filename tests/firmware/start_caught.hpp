// A shaft that turns when it is started: pairs of short circuits whose back-EMFs the test makes up.

#ifndef STILLSPIN_TESTS_FIRMWARE_START_CAUGHT_HPP
#define STILLSPIN_TESTS_FIRMWARE_START_CAUGHT_HPP

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/start/flying/flying.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
}

namespace stillspin::test {

class StartCaught : public Drive {
 protected:
  void SetUp() override {
    NEEDS("start/flying");
    Drive::SetUp();
    use_source(0);
    make_ready();
    drive_command_start();
    period();
    ASSERT_EQ(inside::state(), DRIVE_START);
  }

  /// Ticks from the start of START to the running period.
  static std::uint32_t clock() { return inside::periods() * ESTIMATOR_PERIOD_TICKS; }

  /// The next short circuit, with a back-EMF of this size (V) in this direction (rad) in its middle, which is now.
  static void see_pulse(double direction, double volts) {
    flying_pulse_t& p = flying_start.pulse;
    inside::window_count() = 0;
    p.windows = 2;
    p.first_tick = clock() - 5000;
    p.last_tick = clock() + 5000;
    p.first_q20 = p.last_q20 = {raw(2.0, 20), 0};  // enough to be looked at
    p.drive_q16 = raw_ab(Vector{volts, 0.0}.turned(direction) * 2.0, 16);
    judge();
  }
  /// Of the short circuit that has been seen: the gates go off, it is judged, and the loop is closed where it fits.
  static void judge() {
    start_state.step(&drive);
    EXPECT_FALSE(board.gates_on) << "the current dies away";
    start_state.step(&drive);
    EXPECT_TRUE(inside::wants_exclusive()) << "in a period for itself";
    EXPECT_EQ(inside::start_phase(), START_PULSE);
    inside::is_exclusive() = true;
    start_state.step(&drive);
    inside::is_exclusive() = false;
    if (inside::start_phase() != START_CATCH) return;
    inside::scheduled_task() = TASK_FIELD;
    start_state.step(&drive);
    EXPECT_FALSE(inside::loop_is_closed()) << "not beside the field's control";
    inside::scheduled_task() = TASK_SLOT;
    start_state.step(&drive);
  }
  void await_pulse() {
    for (int n = 0; n < 700 && inside::start_phase() != START_PULSE; ++n) period();
    ASSERT_EQ(inside::start_phase(), START_PULSE);
  }
  /// Two short circuits of a shaft at this speed (rad/s, electrical) whose magnet is `flux` times what was told.
  void catch_at(double speed, double flux) {
    const double volts = std::fabs(speed) * Motor{}.flux * flux;
    await_pulse();
    const std::uint32_t first = clock();
    see_pulse(0.5, volts);
    ASSERT_EQ(inside::start_phase(), START_LISTEN);
    await_pulse();
    see_pulse(0.5 + speed * (clock() - first) * 1e-8, volts);
  }
};

}  // namespace stillspin::test

#endif

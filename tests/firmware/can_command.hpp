// What the tests of the command from the bus have in common: somebody who gives it, and the drive that takes it.

#ifndef STILLSPIN_TESTS_FIRMWARE_CAN_COMMAND_HPP
#define STILLSPIN_TESTS_FIRMWARE_CAN_COMMAND_HPP

#include "tests/firmware/can_frames.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/api/comm_watchdog.h"
#include "firmware/can/command.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {

class CanCommand : public Drive {
 protected:
  can_command_t command = {};
  std::uint16_t alive = 0;

  void SetUp() override {
    NEEDS("can");
    Drive::SetUp();
    can_command_reset(&command);
    use_source(0);
    parameters.polarity_check = 0;
    use_parameters();
  }
  hal_can_frame_t frame(std::int32_t mode, std::int32_t speed = 0, bool clear = false) {
    return command_frame(alive = (alive + 1) % 16, mode, speed, clear);
  }
  void take(const hal_can_frame_t& f) { can_command_take(&command, &f, inside::time_ms()); }
  void pass(int ms) {
    for (int k = 0; k < ms; ++k) {
      for (int n = 0; n < 10; ++n) {
        period();
        forget_windows();
      }
      can_command_service(&command, inside::time_ms());
    }
  }
  /// A command every 10 ms for as long.
  void say(std::int32_t mode, std::int32_t speed, int ms) {
    for (int k = 0; k < ms; k += 10) {
      take(frame(mode, speed));
      pass(10);
    }
  }
  void make_running_by_bus() {
    make_ready();
    say(CAN_MODE_OFF, 0, 20);
    say(CAN_MODE_RUN, 0, 60);
    ASSERT_EQ(inside::state(), DRIVE_RUN);
    ASSERT_TRUE(command.commanding);
  }
  /// By the over-current comparator, which has let go again.
  void make_tripped() {
    make_running_by_bus();
    board.tripped_by_pin = true;
    board.gates_on = false;
    periods(2);
    ASSERT_EQ(inside::state(), DRIVE_FAULT);
    board.tripped_by_pin = false;
  }
};

}  // namespace stillspin::test

#endif

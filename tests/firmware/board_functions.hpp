// A board that the test describes, with its functions at work in the background.

#ifndef STILLSPIN_TESTS_FIRMWARE_BOARD_FUNCTIONS_HPP
#define STILLSPIN_TESTS_FIRMWARE_BOARD_FUNCTIONS_HPP

#include <cmath>
#include <string>

#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/states.h"
#include "hal/hal_board.h"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/steps.h"
}

namespace stillspin::test {

class BoardFunctions : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    inside::be_in(DRIVE_READY);
    inside::loading() = false;
    parameters.rated_current = raw(10.89, 20);
    use_parameters();
    inside::link_q16() = raw(300.0, 16);
  }

  /// The next milliseconds of the background level.
  static void look(int times = 1) {
    for (int n = 0; n < times; ++n) {
      inside::time_ms()++;
      board_service();
    }
  }
  static void look_at_link(double volts, int times = 1) {
    inside::link_q16() = raw(volts, 16);
    look(times);
  }
  /// How many more looks until the drive faults, at most `most`.
  static int looks_to_fault(int most) {
    int n = 0;
    for (; n < most && inside::state() != DRIVE_FAULT; ++n) look();
    return n;
  }
  /// A code of the converter's last place in a window, as a period leaves it.
  static void convert(std::uint16_t code) {
    hal_adc_window_t w = still_window();
    w.aux = code;
    for (int n = 0; n < 2; ++n) {  // both buffers
      board.adc.push_back(w);
      drive_window_interrupt();
      (void)sampling_swap();
    }
  }
  static std::string words() {
    std::uint16_t octets[400];
    octet_writer_t w = octet_writer(octets, 400);
    board_line.put(&w);
    return {octets, octets + w.count};
  }
  static double share() { return interlock_share_q15 / 32768.0; }
};

}  // namespace stillspin::test

#endif

// The image's entry on the board of fakes: what is set up before the interrupts come, and what the background level
// does around its sleep. It never returns: the test leaves it from there.

#include <csetjmp>

#include "tests/firmware/terminal.hpp"

extern "C" {
#include "firmware/board/selftest.h"
#include "firmware/boot/main.h"
#include "firmware/can/messages.h"
#include "firmware/can/segments.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/steps.h"
#include "firmware/hil/hil.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/mode.h"
#include "firmware/store/store.h"
#include "hal/hal_time.h"
}

namespace {

using namespace stillspin::test;

std::jmp_buf way_out;
int sleeps;
bool (*goes_on)(int n);  // at the sleep number n; false leaves

void sleep_once() {
  if (!goes_on(sleeps++)) std::longjmp(way_out, 1);
}

class Main : public ::testing::Test {
 protected:
  void SetUp() override {
    board = FakeBoard{};
    nvm = FakeNvm{};
    hil_reset();
    board.on_idle = sleep_once;
  }
  void TearDown() override { hil_reset(); }
  /// Power-on, until the sleep in which this is false.
  static void run(bool (*until)(int n)) {
    sleeps = 0;
    goes_on = until;
    if (setjmp(way_out) == 0) firmware_main();
  }
  static void run_to_sleep_10() {
    run([](int n) { return n < 10; });
  }
  /// A memory in which these parameters are saved.
  static void save() {
    ASSERT_TRUE(store_save());
    while (store_is_busy()) store_service();
  }
};

TEST_F(Main, WithoutAClockNothingIsSetUp) {
  board.clock_runs = false;
  run_to_sleep_10();
  EXPECT_EQ(sleeps, 11) << "it sleeps for ever";
  EXPECT_EQ(board.baud, 0u);
  EXPECT_EQ(board.control_interrupt, nullptr);
  EXPECT_FALSE(board.interrupts_enabled || board.watchdog || board.safety || board.gates_on);
}

TEST_F(Main, EverythingIsSetUpBeforeTheFirstSleep) {
  board.ground = 7;
  run([](int n) { return n < 0; });
  EXPECT_EQ(board.control_interrupt, &drive_control_interrupt);
  EXPECT_EQ(board.window_interrupt, &drive_window_interrupt);
  EXPECT_TRUE(board.interrupts_enabled);
  EXPECT_TRUE(board.watchdog);
  EXPECT_TRUE(board.safety);
  EXPECT_TRUE(board.adc_set_up);
  EXPECT_EQ(board.baud, 115200u);
  EXPECT_EQ(board.encoder_counts, 4096u);
  EXPECT_EQ(board.dead_band, drive_dead_band_ticks());
  EXPECT_TRUE(inside::config_valid());
  EXPECT_FALSE(board.gates_on);
  EXPECT_EQ(selftest.ground, 7) << "the self-test has looked";
}

TEST_F(Main, ADeadBandThatTheHardwareCannotMakeIsNoConfiguration) {
  board.dead_band_fits = false;
  run_to_sleep_10();
  EXPECT_FALSE(inside::config_valid());
}

// The converter comes up meanwhile. What was saved is in force when the drive leaves BOOT, and not before.
TEST_F(Main, WhatWasSavedIsInForceWhenLoadingEnds) {
  NEEDS("store");
  for (const int latency : {2, 300}) {
    SetUp();
    drive_reset();
    parameters.baud_rate = 230400;
    parameters.speed_ramp = raw(1234.0, 8);
    save();
    nvm.latency = latency;
    board.adc_looks = 5;
    run([](int n) {
      if (inside::loading()) {
        EXPECT_EQ(board.baud, 115200u) << "until it is known";
      } else {
        EXPECT_EQ(parameters.speed_ramp, raw(1234.0, 8));
        EXPECT_FALSE(inside::reload_requested()) << "and the configuration that goes with it";
      }
      return n < 20000 && inside::loading();
    });
    EXPECT_FALSE(inside::loading());
    EXPECT_EQ(board.baud, 230400u);
    EXPECT_EQ(board.baud_calls, 2);
  }
}

// The usual rate is not set up twice, and no record is lost by it.
TEST_F(Main, TheUsualRateIsLeftAsItIs) {
  run([](int n) { return n < 20000 && inside::loading(); });
  EXPECT_FALSE(inside::loading());
  EXPECT_EQ(board.baud_calls, 1);
}

// For a control interrupt that lives, not for a background loop that does; a millisecond apart.
TEST_F(Main, TheWatchdogIsServedForTheControlInterruptAMillisecondApart) {
  run([](int n) {
    board.cycles += HAL_TIME_CYCLES_PER_US * 300u;
    if (n < 40) drive_control_interrupt();
    return n < 80;
  });
  EXPECT_EQ(board.watchdog_services, 10);  // every 1.2 ms of 12
  EXPECT_EQ(selftest.services, 10);
  EXPECT_EQ(selftest.cycles, 12000u * HAL_TIME_CYCLES_PER_US);
  SetUp();
  run([](int n) {
    board.cycles += HAL_TIME_CYCLES_PER_US * 1000u;
    drive_control_interrupt();
    return n < 40;
  });
  EXPECT_EQ(board.watchdog_services, 20) << "more than a millisecond";
}

// A host in the loop has the drive for itself: the background leaves it alone, and its steps stand for the heart.
TEST_F(Main, TheBackgroundLeavesADriveInTheLoopAlone) {
  for (const bool in_the_loop : {false, true}) {
    SetUp();
    static bool enters;
    static int left;
    enters = in_the_loop;
    left = 10;
    run([](int) {
      if (inside::loading() || --left > 5) return true;
      if (left == 5 && enters) {
        EXPECT_EQ(hil_enter(), HIL_OK);
      }
      if (left == 5) drive_parameters_changed();
      return left > 0;
    });
    EXPECT_EQ(inside::reload_requested(), in_the_loop);
  }
}

// The board's own interrupts are then what the watchdog is served for, whatever the drive that is stepped counts.
TEST_F(Main, WithAHostInTheLoopTheBoardsOwnInterruptsFeedTheWatchdog) {
  static int before, sleep;
  sleep = 0;
  run([](int) {
    board.cycles += HAL_TIME_CYCLES_PER_US * 2000u;
    if (inside::loading()) return true;
    if (++sleep == 1) {
      EXPECT_EQ(hil_enter(), HIL_OK);
    }
    if (sleep == 2) before = board.watchdog_services;
    if (sleep > 2 && sleep < 12) inside::heartbeat()++;
    if (sleep == 12) {
      EXPECT_EQ(board.watchdog_services, before);
    }
    if (sleep >= 12) board.control_interrupt();
    return sleep < 20;
  });
  EXPECT_EQ(board.watchdog_services, before + 8);
}

TEST_F(Main, SerialPortBusAndMemoryAreServed) {
  NEEDS("can");
  run([](int n) {
    if (n == 5) {
      for (const char c : std::string("status\r")) board.serial_in.push_back(static_cast<std::uint16_t>(c));
    }
    if (n == 100) {
      EXPECT_TRUE(store_save());
    }
    return n < 20000 && (n <= 100 || store_is_busy());
  });
  EXPECT_FALSE(board.serial_out.empty());
  EXPECT_EQ(board.can_rate, 500000u);
  EXPECT_FALSE(store_is_busy());
  EXPECT_GT(nvm.pages, 0);
}

// A record over the bus is answered as one over the serial port.
TEST_F(Main, ARequestOverTheBusIsAnswered) {
  NEEDS("can");
  run([](int n) {
    if (n == 10) {
      segment_splitter_t s = {};
      s.octets[0] = REQUEST_STATUS;
      s.octets[1] = 1;
      segment_split_begin(&s, 2, 0);
      hal_can_frame_t frame = can_frame(CAN_RECORD_REQUEST, 1);
      for (; segment_split_peek(&s, &frame); segment_split_advance(&s, 0)) board.can_in[2].push_back(frame);
      board.can_out.clear();
    }
    return n < 50;
  });
  bool answered = false;
  for (const hal_can_frame_t& f : board.can_out) answered = answered || f.id == 0x481;
  EXPECT_TRUE(answered);
}

}  // namespace

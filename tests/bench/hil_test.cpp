// A board in the loop as a computer sees it from outside: what it refuses, when it leaves, and records that come close
// behind one another.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>

#include "firmware/api/actions.h"
#include "firmware/link/requests.h"
#include "firmware/mode/commands.h"
#include "hal/f2808/registers.h"
#include "sim_host/bench/board_port.hpp"
#include "sim_host/bench/loop_plugs.hpp"
#include "tests/bench/loop.hpp"

namespace stillspin::bench {
namespace {

TEST_F(Loop, IsLeftByAResetWhenNoStepsCome) {
  ASSERT_EQ(ask({REQUEST_HIL_ENTER}), Words{0});
  EXPECT_TRUE(VirtualBoard::in_loop());
  desk->advance(9 * kSecond);
  EXPECT_EQ(ask({REQUEST_HIL_STEP, 0, 0, 0}).front(), 0) << "an empty period";
  desk->advance(9 * kSecond);
  EXPECT_TRUE(VirtualBoard::in_loop());
  EXPECT_EQ(resets(), 0u);
  desk->advance(2 * kSecond);
  EXPECT_FALSE(VirtualBoard::in_loop());
  EXPECT_EQ(resets(), 1u);
}

TEST_F(Loop, IsNotEnteredWhileThePowerStageIsOn) {
  ASSERT_EQ(ask({REQUEST_COMMAND, COMMAND_START, 0, 0, 0, 0}), Words{0});
  desk->advance(20 * kMillisecond);
  ASSERT_TRUE(drive_is_energised());
  const Words answer = ask({REQUEST_HIL_ENTER});
  EXPECT_EQ(answer.front(), ANSWER_RUNNING);
  EXPECT_FALSE(VirtualBoard::in_loop());
  EXPECT_TRUE(drive_is_energised()) << "nothing has become of what runs";
}

// Whatever is asked of it, from a step to a start: only the watchdog ends it.
TEST_F(Loop, IsLeftByAResetAlone) {
  ASSERT_EQ(ask({REQUEST_HIL_ENTER}), Words{0});
  const std::uint32_t trip_flags = EPWM_BASE(1) + EPWM_TZFLG;
  for (const std::uint16_t code : {COMMAND_START, COMMAND_STOP, COMMAND_RESET, COMMAND_COAST, COMMAND_COMMISSION}) {
    (void)ask({REQUEST_COMMAND, code, 0, 0, 0, 0});
    (void)ask({REQUEST_HIL_ENTER});
    EXPECT_EQ(ask({REQUEST_HIL_STEP, 0, 0, 0}).front(), ANSWER_OK) << "begun anew";
    EXPECT_TRUE(VirtualBoard::in_loop()) << code;
    EXPECT_NE(desk->inspect(trip_flags) & EPWM_TZFLG_OST_MASK, 0) << code;
  }
  EXPECT_EQ(resets(), 0u);
  ASSERT_EQ(ask({REQUEST_HIL_LEAVE}), Words{0});
  desk->advance(30 * kMillisecond);
  EXPECT_EQ(resets(), 1u);
  EXPECT_FALSE(VirtualBoard::in_loop());
}

TEST_F(Loop, ParametersOfASimulationAreNotKept) {
  ASSERT_EQ(ask({REQUEST_HIL_ENTER}), Words{0});
  for (const std::uint16_t code : {COMMAND_SAVE, COMMAND_LOAD, COMMAND_DEFAULTS}) {
    const Words answer = ask({REQUEST_COMMAND, code, 0, 0, 0, 0});
    ASSERT_GT(answer.size(), 1u) << code;
    EXPECT_EQ(answer.front(), ANSWER_STATE) << code;
    EXPECT_EQ(std::string(answer.begin() + 1, answer.end()).substr(0, 31), "not in host-in-the-loop mode: t") << code;
  }
  ASSERT_EQ(ask({REQUEST_HIL_LEAVE}), Words{0});
  desk->advance(200 * kMillisecond);
  EXPECT_EQ(ask({REQUEST_COMMAND, COMMAND_SAVE, 0, 0, 0, 0}), Words{0});
}

TEST_F(Loop, OnlyAWholeStepCounts) {
  ASSERT_EQ(ask({REQUEST_HIL_ENTER}), Words{0});
  EXPECT_EQ(ask({REQUEST_HIL_STEP, 0, 0, 7, 21 << 1, 6 << 1, 0}).front(), ANSWER_LENGTH) << "more windows than can be";
  EXPECT_EQ(ask({REQUEST_HIL_STEP, 0, 0, 4, 2 << 1, 3}).front(), ANSWER_LENGTH) << "cut off";
  EXPECT_EQ(ask({REQUEST_HIL_STEP, 1, 0, 0}).front(), ANSWER_CONFLICT) << "not the first";
  EXPECT_EQ(ask({REQUEST_HIL_STEP, 0, 0, 0}).front(), ANSWER_OK);
}

// Six frames without a gap at 1 Mbit/s, one every 0.1 ms: while one is read the next arrives.
TEST_F(Loop, LongRecordsOnAFastBusLoseNoFrame) {
  const std::unique_ptr<Framing> slcan = slcan_framing(1);
  desk->can_host().set_bit_rate(1'000'000, desk->now());
  desk->advance(20 * kMillisecond);
  int answers = 0;
  constexpr int kRequests = 100;
  for (int k = 0; k < kRequests; k++) {
    Words request{REQUEST_SIGNALS, static_cast<std::uint16_t>(k)};
    for (std::uint16_t signal = 0; signal < 16; signal++) request.insert(request.end(), {signal, 0});
    const Octets lines = slcan->wrap(request);
    for (std::size_t at = 0; at < lines.size();) {
      chip::CanFrame frame;
      const std::string line(lines.begin() + at, std::find(lines.begin() + at, lines.end(), '\r'));
      frame.id = static_cast<std::uint32_t>(std::stoul(line.substr(1, 3), nullptr, 16));
      frame.length = static_cast<std::uint8_t>(line[4] - '0');
      for (unsigned n = 0; n < frame.length; n++)
        frame.data[n] = static_cast<std::uint8_t>(std::stoul(line.substr(5 + 2 * n, 2), nullptr, 16));
      desk->can_host().send(frame, desk->now());
      at += line.size() + 1;
    }
    desk->advance(5 * kMillisecond + 97 * k);  // every phase of the period
    for (const auto& heard : desk->can_host().take_heard(desk->now())) {
      if (heard.frame.id == 0x481 && (heard.frame.data[0] & 0x40) != 0) answers++;
    }
  }
  EXPECT_EQ(answers, kRequests);
}

// ---- the plugs of a board in the loop, served without Python

// A board in the loop, and programs at its port and its adapter.
class Plugs : public Loop {
 protected:
  static constexpr int kLong = 60'000, kShort = 20;  // ms

  std::array<int, 2> port{}, adapter{};

  void SetUp() override {
    Loop::SetUp();
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, port.data()), 0);
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, adapter.data()), 0);
    desk->can_host().set_bit_rate(1'000'000, desk->now());
    desk->advance(20 * kMillisecond);
    ASSERT_EQ(ask({REQUEST_HIL_ENTER}), Words{0});
    (void)desk->can_host().take_heard(desk->now());  // the bus carries records alone from here on
  }
  void TearDown() override {
    for (const int end : {port[0], port[1], adapter[0], adapter[1]}) ::close(end);
  }
  LoopPlugs::Served serve(int milliseconds) { return LoopPlugs(*desk, port[0], adapter[0]).serve(milliseconds); }
  static void type(int end, const Octets& octets) {
    ASSERT_EQ(::write(end, octets.data(), octets.size()), static_cast<ssize_t>(octets.size()));
  }
  static Octets text(const std::string& characters) { return Octets(characters.begin(), characters.end()); }
  static Octets seen(int end) {
    Octets octets(4096);
    const ssize_t n = ::read(end, octets.data(), octets.size());
    octets.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return octets;
  }
  // The record that octets of a plug end with.
  static Words record_in(Framing& framing, const Octets& octets) {
    for (const std::uint8_t octet : octets) {
      if (framing.take(octet)) return framing.record();
    }
    return {};
  }
};

TEST_F(Plugs, StepsPassThroughThePort) {
  for (std::uint16_t step = 0; step < 3; step++) {
    const Octets request = serial->wrap({REQUEST_HIL_STEP, 7, step, 0, 0});
    type(port[1], request);
    const LoopPlugs::Served served = serve(kShort);
    EXPECT_EQ(served.serial_in, request.size());
    const Octets heard = seen(port[1]);
    EXPECT_EQ(served.serial_out, heard.size());
    const Words answer = record_in(*serial, heard);
    ASSERT_GT(answer.size(), 4u);
    EXPECT_EQ(answer[2], ANSWER_OK);
    EXPECT_EQ(answer[3], step);
  }
}

TEST_F(Plugs, StepsPassThroughTheAdapter) {
  const std::unique_ptr<Framing> slcan = slcan_framing(1);
  for (std::uint16_t step = 0; step < 3; step++) {
    type(adapter[1], slcan->wrap({REQUEST_HIL_STEP, 7, step, 0, 0}));
    const LoopPlugs::Served served = serve(kShort);
    EXPECT_TRUE(served.for_adapter.empty());
    const Octets heard = seen(adapter[1]);
    ASSERT_GT(heard.size(), 2u);
    EXPECT_EQ(heard[0], 'z') << "the frame is acknowledged";
    const Words answer = record_in(*slcan, heard);
    ASSERT_GT(answer.size(), 4u);
    EXPECT_EQ(answer[2], ANSWER_OK);
    EXPECT_EQ(answer[3], step);
  }
}

TEST_F(Plugs, WhatIsNoPlainFrameIsTheAdaptersBusiness) {
  for (const std::string other :
       {"V", "r4010", "T000004010", "t401", "t40190", "t401112z", "t80110A", "t401100AA", ""}) {
    type(adapter[1], text("t7FF0\r" + other + "\rt7FF0\rt7"));
    EXPECT_EQ(serve(kLong).for_adapter, text(other + "\rt7FF0\rt7")) << other;
    EXPECT_EQ(seen(adapter[1]), text("z\r")) << other;
  }
}

TEST_F(Plugs, ALineThatIsNotCompleteIsHandedBack) {
  type(adapter[1], text("t40"));
  EXPECT_EQ(serve(kShort).for_adapter, text("t40"));
}

TEST_F(Plugs, AProgramThatGoesEndsIt) {
  ::shutdown(port[1], SHUT_RDWR);
  const LoopPlugs::Served served = serve(kLong);
  EXPECT_EQ(served.serial_in, 0u);
  EXPECT_TRUE(VirtualBoard::in_loop());
}

TEST_F(Plugs, TheEndOfTheLoopEndsIt) {
  type(port[1], serial->wrap({REQUEST_HIL_LEAVE, 9}));
  (void)serve(kLong);
  EXPECT_FALSE(VirtualBoard::in_loop());
}

// What is said of a port at whose other end nobody answers.
std::string words_of(const std::function<void(int)>& at_the_other_end) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return "no pair of sockets";
  at_the_other_end(ends[1]);
  std::string words;
  try {
    BoardPort port(ends[0], serial_framing());
    port.send({REQUEST_HIL_ENTER});
    (void)port.receive();
  } catch (const PortError& error) {
    words = error.what();
  }
  ::close(ends[0]);
  return words;
}

TEST(BoardPort, SaysWhenNoAnswerComes) {
  int other = -1;
  EXPECT_EQ(words_of([&](int end) { other = end; }), "the board does not answer");
  std::array<char, 64> heard;
  EXPECT_EQ(::read(other, heard.data(), heard.size()) % 5, 0) << "asked five times";
  ::close(other);
}

TEST(BoardPort, SaysWhenThePortIsGone) {
  EXPECT_EQ(words_of([](int end) { ::shutdown(end, SHUT_WR); }), "the port is lost: it has been closed");
}

}  // namespace
}  // namespace stillspin::bench

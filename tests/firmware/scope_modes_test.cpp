// One capture or one after another, what can be read of it, and which set-ups are refused.

#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "tests/firmware/scope.hpp"

namespace {

using namespace stillspin::test;

TEST_F(Scope, SingleStaysDone) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  arm(s);
  interrupts(SCOPE_DEPTH);
  (void)read();
  interrupts(100);
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  expect_consecutive(read(), 0);
}

TEST_F(Scope, AutoArmsAgainWhenEveryChannelHasBeenRead) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.mode = SCOPE_AUTO;
  s.count = 2;
  s.channel[1] = {signal_current_q, 0};
  arm(s);
  interrupts(2000);
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  std::int16_t word;
  EXPECT_EQ(scope_read(0, SCOPE_DEPTH - 2, &word, 1), 1);
  (void)read(1);
  (void)read(1);
  EXPECT_EQ(scope_read(0, SCOPE_DEPTH, &word, 1), 0) << "behind the last word there is none to give";
  EXPECT_EQ(scope_status().state, SCOPE_DONE) << "channel 0 has not been read to its end";
  EXPECT_EQ(scope_read(0, SCOPE_DEPTH - 1, &word, 1), 1);
  EXPECT_EQ(word, int(SCOPE_DEPTH) - 1);
  EXPECT_EQ(scope_status().state, SCOPE_FILLING);
  interrupts(SCOPE_DEPTH);
  expect_consecutive(read(0), 2000);
}

TEST_F(Scope, StopEndsAuto) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.mode = SCOPE_AUTO;
  arm(s);
  interrupts(SCOPE_DEPTH);
  scope_stop();
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  (void)read();
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
}

TEST_F(Scope, WhatWasRecordedBeforeAStopCanBeRead) {
  arm(counting());
  interrupts(30);
  std::int16_t word;
  EXPECT_EQ(scope_read(0, 0, &word, 1), 0) << "not while it runs";
  scope_stop();
  EXPECT_EQ(scope_status().state, SCOPE_IDLE);
  EXPECT_EQ(scope_status().recorded, 30);
  EXPECT_EQ(scope_status().trigger_at, SCOPE_NOWHERE);
  interrupts(5);
  const std::vector<int> words = read();
  ASSERT_EQ(words.size(), 30u);
  EXPECT_EQ(words.front(), 0);
  EXPECT_EQ(words.back(), 29);
}

TEST_F(Scope, ArmingStartsAgain) {
  arm(counting());
  interrupts(30);
  interrupt(100);
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
  EXPECT_TRUE(scope_arm());
  EXPECT_EQ(scope_status().state, SCOPE_FILLING);
  EXPECT_EQ(scope_status().recorded, 0);
  EXPECT_EQ(scope_status().trigger_at, SCOPE_NOWHERE);
}

TEST_F(Scope, ReadingStaysInsideTheRecords) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  arm(s);
  interrupts(SCOPE_DEPTH);
  std::array<std::int16_t, 200> words;
  EXPECT_EQ(scope_read(0, SCOPE_DEPTH - 24, words.data(), 200), 24);
  EXPECT_EQ(scope_read(0, SCOPE_DEPTH, words.data(), 200), 0);
  EXPECT_EQ(scope_read(0, 65535, words.data(), 200), 0);
  EXPECT_EQ(scope_read(1, 0, words.data(), 200), 0) << "no such channel";
  EXPECT_EQ(scope_read(0, 0, words.data(), 0), 0);
}

TEST_F(Scope, RefusedSetUpsChangeNothing) {
  arm(counting());
  interrupts(10);
  const auto refused = [&](auto change) {
    scope_setup_t s = counting();
    change(s);
    EXPECT_FALSE(scope_setup(&s));
    EXPECT_EQ(scope_status().recorded, 10);
    EXPECT_EQ(scope_setup_in_force()->decimation, 1);
  };
  refused([](scope_setup_t& s) { s.decimation = 0; });
  refused([](scope_setup_t& s) { s.pretrigger = SCOPE_DEPTH; });
  refused([](scope_setup_t& s) { s.mode = static_cast<scope_mode_t>(2); });
  refused([](scope_setup_t& s) { s.edge = static_cast<scope_edge_t>(6); });
  refused([](scope_setup_t& s) { s.trigger = signals_listed; });
  refused([](scope_setup_t& s) { s.count = 0; });
  refused([](scope_setup_t& s) { s.count = 5; });
  for (int k = 0; k < int(SCOPE_CHANNELS); ++k) {
    refused([&](scope_setup_t& s) { s.channel[k].signal = signals_listed; });
    refused([&](scope_setup_t& s) { s.channel[k].shift = 32; });
  }
}

TEST_F(Scope, ASetUpMayBeAtTheEndOfEveryRange) {
  scope_setup_t s = counting();
  s.decimation = 65535;
  s.pretrigger = SCOPE_DEPTH - 1;
  s.mode = SCOPE_AUTO;
  s.edge = SCOPE_BELOW;
  s.trigger = signals_listed - 1;
  s.count = SCOPE_CHANNELS;
  for (scope_channel_t& c : s.channel) c = {signals_listed - 1, SCOPE_SHIFT_MAX};
  arm(s);
  EXPECT_EQ(scope_setup_in_force()->pretrigger, SCOPE_DEPTH - 1);
  EXPECT_EQ(scope_setup_in_force()->channel[3].signal, signals_listed - 1);
  interrupts(65535);
  EXPECT_EQ(scope_status().recorded, 1);
  interrupt();
  EXPECT_EQ(scope_status().recorded, 2);
}

TEST_F(Scope, PowerOnForgetsEverything) {
  arm(counting());
  interrupts(10);
  drive_reset();
  EXPECT_EQ(scope_status().state, SCOPE_IDLE);
  EXPECT_EQ(scope_status().recorded, 0);
  EXPECT_EQ(scope_setup_in_force()->count, 0);
  EXPECT_FALSE(scope_arm());
}

}  // namespace

// The captured scope on counted interrupts: which records a capture holds, where its trigger lies, what is refused.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/scope/scope.h"
}

namespace {

using namespace stillspin::test;

enum : std::uint16_t {
#define SIGNAL(name, unit, q, value, meaning) signal_##name,
#include "firmware/signal_list.h"
#undef SIGNAL
  signal_count
};

class Scope : public Drive {
 protected:
  /// Interrupt number n: `current_d` is n, `current_q` what the test says.
  void interrupt(std::int32_t current = 0) {
    drive.control.measured_q20.d = static_cast<std::int32_t>(n_);
    drive.control.measured_q20.q = current;
    scope_step(n_ / 10u);
    n_++;
  }
  void interrupts(int count, std::int32_t current = 0) {
    for (int k = 0; k < count; ++k) interrupt(current);
  }

  /// Records the interrupt's number, triggers when current_q rises to 100.
  scope_setup_t counting() const {
    scope_setup_t s = {};
    s.decimation = 1;
    s.trigger = signal_current_q;
    s.level = 100;
    s.count = 1;
    s.channel[0] = {signal_current_d, 0};
    return s;
  }

  void arm(const scope_setup_t& s) {
    ASSERT_TRUE(scope_setup(&s));
    ASSERT_TRUE(scope_arm());
  }

  static std::vector<int> read(std::uint16_t channel = 0) {
    std::vector<int> all;
    std::array<std::int16_t, 100> words;
    for (;;) {
      const std::uint16_t got =
          scope_read(channel, static_cast<std::uint16_t>(all.size()), words.data(), std::uint16_t(words.size()));
      all.insert(all.end(), words.begin(), words.begin() + got);
      if (got < words.size()) return all;
    }
  }

  void expect_consecutive(const std::vector<int>& words, int first, int step = 1) {
    ASSERT_EQ(words.size(), SCOPE_DEPTH);
    for (int k = 0; k < int(SCOPE_DEPTH); ++k) ASSERT_EQ(words[std::size_t(k)], first + k * step) << k;
  }

  std::uint32_t n_ = 0;
};

TEST_F(Scope, SignalsAreThoseOfTheList) { EXPECT_EQ(::signal_count(), signal_count); }

TEST_F(Scope, DoesNothingBeforeItIsArmed) {
  EXPECT_FALSE(scope_arm()) << "there is no set-up";
  interrupts(10);
  EXPECT_EQ(scope_status().state, SCOPE_IDLE);
  EXPECT_EQ(scope_status().recorded, 0);
  std::int16_t word;
  EXPECT_EQ(scope_read(0, 0, &word, 1), 0);
}

TEST_F(Scope, TriggerLiesBehindItsPretrigger) {
  scope_setup_t s = counting();
  s.pretrigger = 100;
  arm(s);
  interrupts(100);
  EXPECT_EQ(scope_status().state, SCOPE_FILLING);
  interrupts(400);
  EXPECT_EQ(scope_status().state, SCOPE_ARMED);
  EXPECT_EQ(scope_status().trigger_at, SCOPE_NOWHERE);
  interrupt(100);  // number 500
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
  EXPECT_EQ(scope_status().trigger_time_ms, 50u);
  EXPECT_EQ(scope_status().recorded, 501);
  EXPECT_EQ(scope_status().trigger_at, 500);
  interrupts(922);
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
  interrupt();
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  EXPECT_EQ(scope_status().trigger_at, 100);
  expect_consecutive(read(), 400);
}

TEST_F(Scope, RingWrapsManyTimes) {
  for (const int before : {1023, 1024, 1025, 5000, 10239}) {
    for (const std::uint16_t pretrigger : {0, 1, 512, 1023}) {
      scope_setup_t s = counting();
      s.pretrigger = pretrigger;
      n_ = 0;
      arm(s);
      interrupts(before);
      interrupt(100);
      interrupts(1024);
      ASSERT_EQ(scope_status().state, SCOPE_DONE);
      ASSERT_EQ(scope_status().trigger_at, pretrigger);
      expect_consecutive(read(), before - pretrigger);
    }
  }
}

TEST_F(Scope, WhatHappensInThePretriggerPartDoesNotTrigger) {
  scope_setup_t s = counting();
  s.pretrigger = 100;
  arm(s);
  interrupts(50);
  interrupts(10, 100);  // an edge up and one down
  interrupts(39);
  interrupts(100, 100);  // the edge of the last interrupt that still fills: it stays above
  EXPECT_EQ(scope_status().state, SCOPE_ARMED);
  interrupt(0);
  interrupt(100);
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
}

TEST_F(Scope, FirstInterruptBehindThePretriggerTriggers) {
  scope_setup_t s = counting();
  s.pretrigger = 100;
  arm(s);
  interrupts(100);
  interrupt(100);
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
  interrupts(1024);
  expect_consecutive(read(), 0);
}

// A value that is above when the scope is armed has not risen.
TEST_F(Scope, AnEdgeNeedsAValueBefore) {
  interrupts(3, -500);
  arm(counting());
  interrupts(5, 500);
  EXPECT_EQ(scope_status().state, SCOPE_ARMED);
}

struct EdgeCase {
  scope_edge_t edge;
  std::vector<int> values;
  int at;  // interrupt that triggers, -1: none
};

TEST_F(Scope, Edges) {
  const EdgeCase cases[] = {
      {SCOPE_RISING, {0, 99, 100, 0, 100}, 2},
      {SCOPE_RISING, {200, 100, 99, 98, 100}, 4},
      {SCOPE_RISING, {100, 150, 100}, -1},
      {SCOPE_FALLING, {0, 99, 100, 99, 0}, 3},
      {SCOPE_FALLING, {200, 100, 100}, -1},
      {SCOPE_EITHER, {0, 99, 100, 99}, 2},
      {SCOPE_EITHER, {200, 100, 99, 100}, 2},
      {SCOPE_EITHER, {200, 100, 300}, -1},
      {SCOPE_AT_ONCE, {0, 0}, 0},
      {SCOPE_ABOVE, {100, 0}, 0},
      {SCOPE_ABOVE, {99, 99, 101}, 2},
      {SCOPE_BELOW, {100, 99}, 1},
      {SCOPE_RISING, {-2147483647 - 1, 100}, 1},  // the distance does not fit 32 bits
      {SCOPE_FALLING, {2147483647, -2147483647}, 1},
  };
  for (const EdgeCase& c : cases) {
    scope_setup_t s = counting();
    s.edge = c.edge;
    arm(s);
    int at = -1;
    for (std::size_t k = 0; k < c.values.size(); ++k) {
      interrupt(c.values[k]);
      if (at < 0 && scope_status().state == SCOPE_TRIGGERED) at = int(k);
    }
    EXPECT_EQ(at, c.at) << "edge " << c.edge << " case " << (&c - cases);
  }
}

TEST_F(Scope, AtOnceStillHasItsPretrigger) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.pretrigger = 1000;
  arm(s);
  interrupts(1024);
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  EXPECT_EQ(scope_status().trigger_at, 1000);
  expect_consecutive(read(), 0);
}

TEST_F(Scope, DecimationKeepsOneInSoMany) {
  scope_setup_t s = counting();
  s.decimation = 7;
  s.edge = SCOPE_AT_ONCE;
  arm(s);
  interrupts(1023 * 7);
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
  interrupt();
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  expect_consecutive(read(), 0, 7);
}

// A pulse of one interrupt between two records is the trigger of the next record.
TEST_F(Scope, TriggerIsSeenBetweenTwoRecords) {
  scope_setup_t s = counting();
  s.decimation = 10;
  s.pretrigger = 3;
  arm(s);
  interrupts(52);  // records at 0, 10 .. 50
  interrupt(100);  // 52
  interrupts(7);
  EXPECT_EQ(scope_status().state, SCOPE_ARMED);
  interrupt();  // 60
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
  interrupts(10 * 1024);
  expect_consecutive(read(), 30, 10);
}

TEST_F(Scope, WordsAreShiftedAndSaturated) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.count = 4;
  s.channel[0] = {signal_current_q, 0};
  s.channel[1] = {signal_current_q, 4};
  s.channel[2] = {signal_current_q, 16};
  s.channel[3] = {signal_current_q, 31};
  arm(s);
  const std::int32_t values[] = {0,       32767, 32768, -32768, -32769, 524287,     524288,
                                 -524289, 15,    -1,    -16,    -17,    2147483647, -2147483647 - 1};
  for (const std::int32_t v : values) interrupt(v);
  interrupts(1024);
  for (std::uint16_t channel = 0; channel < 4; ++channel) {
    const std::vector<int> words = read(channel);
    for (std::size_t k = 0; k < std::size(values); ++k) {
      const double shifted = std::floor(std::ldexp(double(values[k]), -int(s.channel[channel].shift)));
      EXPECT_EQ(words[k], std::clamp(shifted, -32768.0, 32767.0)) << values[k] << " channel " << channel;
    }
  }
}

TEST_F(Scope, SingleStaysDone) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  arm(s);
  interrupts(1024);
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
  EXPECT_EQ(scope_read(0, 1022, &word, 1), 1);
  (void)read(1);
  (void)read(1);
  EXPECT_EQ(scope_read(0, 1024, &word, 1), 0) << "behind the last word there is none to give";
  EXPECT_EQ(scope_status().state, SCOPE_DONE) << "channel 0 has not been read to its end";
  EXPECT_EQ(scope_read(0, 1023, &word, 1), 1);
  EXPECT_EQ(word, 1023);
  EXPECT_EQ(scope_status().state, SCOPE_FILLING);
  interrupts(1024);
  expect_consecutive(read(0), 2000);
}

TEST_F(Scope, StopEndsAuto) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.mode = SCOPE_AUTO;
  arm(s);
  interrupts(1024);
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
  interrupts(1024);
  std::array<std::int16_t, 200> words;
  EXPECT_EQ(scope_read(0, 1000, words.data(), 200), 24);
  EXPECT_EQ(scope_read(0, 1024, words.data(), 200), 0);
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
  refused([](scope_setup_t& s) { s.pretrigger = 1024; });
  refused([](scope_setup_t& s) { s.mode = static_cast<scope_mode_t>(2); });
  refused([](scope_setup_t& s) { s.edge = static_cast<scope_edge_t>(6); });
  refused([](scope_setup_t& s) { s.trigger = signal_count; });
  refused([](scope_setup_t& s) { s.count = 0; });
  refused([](scope_setup_t& s) { s.count = 5; });
  for (int k = 0; k < int(SCOPE_CHANNELS); ++k) {
    refused([&](scope_setup_t& s) { s.channel[k].signal = signal_count; });
    refused([&](scope_setup_t& s) { s.channel[k].shift = 32; });
  }
}

TEST_F(Scope, ASetUpMayBeAtTheEndOfEveryRange) {
  scope_setup_t s = counting();
  s.decimation = 65535;
  s.pretrigger = SCOPE_DEPTH - 1;
  s.mode = SCOPE_AUTO;
  s.edge = SCOPE_BELOW;
  s.trigger = signal_count - 1;
  s.count = SCOPE_CHANNELS;
  for (scope_channel_t& c : s.channel) c = {signal_count - 1, SCOPE_SHIFT_MAX};
  arm(s);
  EXPECT_EQ(scope_setup_in_force()->pretrigger, SCOPE_DEPTH - 1);
  EXPECT_EQ(scope_setup_in_force()->channel[3].signal, signal_count - 1);
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

// In its place: the control interrupt records what it has just published, and the clock counts its milliseconds.
TEST_F(Scope, RunsInTheControlInterrupt) {
  make_ready();
  EXPECT_EQ(drive.time_ms, 40u);
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.channel[0] = {signal_state, 0};
  arm(s);
  period();
  drive_raise(&drive, FAULT_STOP);
  periods(1024);
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  EXPECT_EQ(scope_status().trigger_time_ms, 40u);
  const std::vector<int> words = read();
  EXPECT_EQ(words[0], DRIVE_READY);
  EXPECT_EQ(words[1], DRIVE_FAULT);
}

}  // namespace

// Which records a capture holds, and where its trigger lies.

#include "tests/firmware/scope.hpp"

#include "firmware/drive/signals.h"
#include "firmware/mode/states.h"

namespace {

using namespace stillspin::test;

TEST_F(Scope, SignalsAreThoseOfTheList) { EXPECT_EQ(::signal_count(), signals_listed); }

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
  interrupts(SCOPE_DEPTH - 102);
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
  interrupt();
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  EXPECT_EQ(scope_status().trigger_at, 100);
  expect_consecutive(read(), 400);
}

TEST_F(Scope, RingWrapsManyTimes) {
  for (const int before : {int(SCOPE_DEPTH) - 1, int(SCOPE_DEPTH), int(SCOPE_DEPTH) + 1, 5000, 10239}) {
    for (const std::uint16_t pretrigger : {0u, 1u, 256u, SCOPE_DEPTH - 1u}) {
      scope_setup_t s = counting();
      s.pretrigger = pretrigger;
      n_ = 0;
      arm(s);
      interrupts(before);
      interrupt(100);
      interrupts(SCOPE_DEPTH);
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
  interrupts(SCOPE_DEPTH);
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

TEST_F(Scope, AnEdgeComesFromBeyondTheHysteresis) {
  const EdgeCase cases[] = {
      {SCOPE_RISING, {200, 99, 101, 91, 100, 90, 100, 89, 100}, 8},
      {SCOPE_FALLING, {0, 101, 99, 109, 99, 110, 100, 99}, 7},
      {SCOPE_EITHER, {100, 99, 100, 90, 100, 89, 95, 100}, 7},
      {SCOPE_EITHER, {0, 109, 99}, 1},
      {SCOPE_ABOVE, {99, 100}, 1},
      {SCOPE_BELOW, {100, 99}, 1},
      {SCOPE_RISING, {-2147483647 - 1, 100}, 1},
  };
  for (const EdgeCase& c : cases) {
    scope_setup_t s = counting();
    s.hysteresis = 10;
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

// A fall over a second with noise on it, of which each rise is through the level: none of them counts, and the real one
// does. The noise is a twentieth of the fall, uniform and new in each interrupt.
TEST_F(Scope, NoiseOnASignalThatFallsIsNoRise) {
  const auto triggered = [&](std::int32_t hysteresis, bool comes_back) {
    std::uint32_t random = 1;
    scope_setup_t s = counting();
    s.level = 500000;
    s.hysteresis = hysteresis;
    arm(s);
    for (int k = 0; k < (comes_back ? 20000 : 10000); ++k) {
      random = random * 1664525u + 1013904223u;
      interrupt(100 * (k < 10000 ? 10000 - k : k - 10000) + std::int32_t((random >> 16) * 3 / 4));
    }
    return scope_status().state >= SCOPE_TRIGGERED;
  };
  EXPECT_TRUE(triggered(0, false)) << "as it is without";
  EXPECT_FALSE(triggered(SCOPE_BY_SPAN, false));
  EXPECT_TRUE(triggered(SCOPE_BY_SPAN, true));
  EXPECT_FALSE(triggered(49152, false)) << "as much as the noise";
}

// The span is that of late: after a great change small ones count again.
TEST_F(Scope, AGreatChangeIsForgotten) {
  scope_setup_t s = counting();
  s.level = 50000;
  s.hysteresis = SCOPE_BY_SPAN;
  arm(s);
  interrupts(100, 0);
  interrupts(100, 40 * 1000 * 1000);
  ASSERT_EQ(scope_status().state, SCOPE_TRIGGERED);
  arm(s);
  interrupts(10, 40 * 1000 * 1000);
  interrupts(1000, 0);
  interrupt(50000);
  EXPECT_EQ(scope_status().state, SCOPE_ARMED);
  interrupts(60000, 0);
  interrupt(50000);
  EXPECT_EQ(scope_status().state, SCOPE_TRIGGERED);
}

TEST_F(Scope, AtOnceStillHasItsPretrigger) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.pretrigger = 500;
  arm(s);
  interrupts(SCOPE_DEPTH);
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  EXPECT_EQ(scope_status().trigger_at, 500);
  expect_consecutive(read(), 0);
}

TEST_F(Scope, DecimationKeepsOneInSoMany) {
  scope_setup_t s = counting();
  s.decimation = 7;
  s.edge = SCOPE_AT_ONCE;
  arm(s);
  interrupts((SCOPE_DEPTH - 1) * 7);
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
  interrupts(10 * SCOPE_DEPTH);
  expect_consecutive(read(), 30, 10);
}

// Also in a channel of which a shift leaves nothing but the sign.
TEST_F(Scope, WhatIsUnknownIsNoNumber) {
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.pretrigger = 0;
  s.count = 3;
  s.channel[0] = {signal_current_q, 0};
  s.channel[1] = {signal_current_q, 31};
  s.channel[2] = {signal_state, 0};
  arm(s);
  interrupts(4, -1);
  inside::be_in(DRIVE_READY);
  if (drive_onlooker != nullptr) drive_onlooker();
  interrupts(SCOPE_DEPTH, -1);
  for (std::uint16_t channel = 0; channel < 2; ++channel) {
    const std::vector<int> words = read(channel);
    EXPECT_EQ(words[3], -1);
    EXPECT_EQ(words[4], SCOPE_UNKNOWN);
    EXPECT_EQ(words[5], -1);
  }
  EXPECT_EQ(read(2)[4], DRIVE_READY);
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
  interrupts(SCOPE_DEPTH);
  for (std::uint16_t channel = 0; channel < 4; ++channel) {
    const std::vector<int> words = read(channel);
    for (std::size_t k = 0; k < std::size(values); ++k) {
      const double shifted = std::floor(std::ldexp(double(values[k]), -int(s.channel[channel].shift)));
      EXPECT_EQ(words[k], std::clamp(shifted, -32767.0, 32767.0)) << values[k] << " channel " << channel;
    }
  }
}

// In its place: the control interrupt records what it has just published, and the clock counts its milliseconds.
TEST_F(Scope, RunsInTheControlInterrupt) {
  make_ready();
  EXPECT_EQ(inside::time_ms(), 40u);
  scope_setup_t s = counting();
  s.edge = SCOPE_AT_ONCE;
  s.channel[0] = {signal_state, 0};
  arm(s);
  period();
  drive_trip(&drive, FAULT_STOP);
  periods(SCOPE_DEPTH);
  EXPECT_EQ(scope_status().state, SCOPE_DONE);
  EXPECT_EQ(scope_status().trigger_time_ms, 40u);
  const std::vector<int> words = read();
  EXPECT_EQ(words[0], DRIVE_READY);
  EXPECT_EQ(words[1], DRIVE_FAULT);
}

}  // namespace

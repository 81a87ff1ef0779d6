// When a shaft counts as stalled: a reference, all the torque there is, and no way made. Each condition alone, and the
// times.

#include <algorithm>
#include <cmath>

#include "firmware/board/functions.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "tests/firmware/fake_hal.hpp"

namespace stillspin::test {
namespace {

constexpr double kDegree = 4294967296.0 / 360.0;

class Stall : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    inside::be_in(DRIVE_RUN);
    inside::loading() = false;
    inside::link_q16() = raw(300.0, 16);
    refer(100);
    inside::limits() = LIMIT_CURRENT;
    parameters.stall_time = 500;
  }
  static void refer(int rpm) { inside::ramped_bpp() = rpm < 0 ? -bpp_of(-rpm) : bpp_of(rpm); }
  static void look() {
    inside::time_ms()++;
    board_service();
  }
  /// Milliseconds until the fault, `most` without one; the shaft turns at rpm meanwhile.
  static int looks_to_fault(double rpm, int most) {
    double angle = 0.0;
    for (int n = 1; n <= most; ++n) {
      angle += rpm / 60.0 * 4.0 * 360.0 * 1e-3;
      inside::selected().angle_bam = static_cast<std::uint32_t>(static_cast<std::int64_t>(angle * kDegree));
      inside::selected().speed_bpp = rpm < 0 ? -bpp_of(int(-rpm)) : bpp_of(int(rpm));
      look();
      if (inside::state() == DRIVE_FAULT) return n;
    }
    return most;
  }
  void expect_none(double rpm) {
    EXPECT_EQ(looks_to_fault(rpm, 5000), 5000) << rpm;
    EXPECT_EQ(inside::fault(), FAULT_NONE) << rpm;
  }
  void expect_stall(double rpm) {
    EXPECT_NEAR(looks_to_fault(rpm, 5000), 501, 2) << rpm;
    EXPECT_EQ(inside::fault(), FAULT_STALL) << rpm;
  }
};

TEST_F(Stall, ABlockedShaftIsAFaultAfterItsTime) {
  expect_stall(0.0);
  EXPECT_FALSE(board.gates_on);
}

TEST_F(Stall, SoIsOneThatIsPushedBack) {
  expect_stall(-100.0);
  SetUp();
  refer(-100);
  expect_stall(100.0);
}

TEST_F(Stall, NeverAtAReferenceOfZero) {
  refer(0);
  expect_none(0.0);
}

TEST_F(Stall, NotBelowTheLimitOfTheCurrent) {
  for (const int limits : {0, int(LIMIT_VOLTAGE), int(LIMIT_WEAKENING | LIMIT_BRAKING | LIMIT_OVERRUN)}) {
    inside::limits() = limits;
    expect_none(0.0);
  }
}

TEST_F(Stall, NotInAnotherStateThanRun) {
  for (const drive_state_t state : {DRIVE_READY, DRIVE_START, DRIVE_STOP, DRIVE_COMMISSION}) {
    inside::be_in(state);
    expect_none(0.0);
    EXPECT_EQ(inside::state(), state);
  }
}

// Wherever a shaft has got to, it is from there that it has to get on.
TEST_F(Stall, AShaftThatIsBlockedOnItsWayIsAFaultAfterItsTime) {
  for (const double rpm : {100.0, -100.0}) {
    for (const int ms : {100, 137, 150, 163, 175}) {  // at other angles of the turn
      SetUp();
      refer(static_cast<int>(rpm));
      ASSERT_EQ(looks_to_fault(rpm, ms), ms);
      inside::selected().speed_bpp = 0;
      int n = 0;
      for (; n < 5000 && inside::state() == DRIVE_RUN; ++n) look();
      EXPECT_NEAR(n, 501, 60) << rpm << ", " << ms;  // the last of the way may have been short
      EXPECT_EQ(inside::fault(), FAULT_STALL) << rpm << ", " << ms;
    }
  }
}

// What is a way made lies between eight degrees, however slow the reference is, and a quarter of a turn, however fast.
TEST_F(Stall, AWayMadeIsFromEightDegreesToAQuarterTurn) {
  for (const auto& [reference, degrees] : {std::pair{1000, 8.0}, {bpp_of(100), 90.0}}) {
    for (const double share : {0.98, 1.02}) {
      for (const int sign : {1, -1}) {
        SetUp();
        inside::ramped_bpp() = sign * reference;
        for (int n = 0; n < 100; ++n) look();
        ASSERT_EQ(::board.stalled_ms, 100);
        inside::selected().angle_bam = static_cast<std::uint32_t>(std::llround(sign * share * degrees * kDegree));
        look();
        EXPECT_EQ(::board.stalled_ms, share > 1.0 ? 1 : 101) << degrees * share * sign;
      }
    }
  }
}

// One that turns back slows down when it has lost a sixteenth of its speed and two thirds of a hertz.
TEST_F(Stall, ASixteenthOfTheSpeedIsSlower) {
  for (const double hertz : {0.655, 0.68}) {
    for (const int sign : {1, -1}) {
      SetUp();
      refer(sign * 100);
      const std::int32_t back = bpp_of(800);
      inside::selected().speed_bpp = -sign * back;
      for (int n = 0; n < 100; ++n) look();
      inside::selected().speed_bpp = -sign * (back - back / 16 - raw(hertz * 1e-4, 32));
      look();
      EXPECT_EQ(::board.stalled_ms, hertz > 2.0 / 3.0 ? 1 : 101) << hertz * sign;
    }
  }
}

// Beyond a quarter of a turn in a millisecond the angle tells no direction.
TEST_F(Stall, AQuarterOfATurnInAMillisecondIsTooFast) {
  for (const double share : {0.99, 1.01, -0.99, -1.01}) {
    SetUp();
    inside::selected().speed_bpp = raw(share * 0.25 / 10.0, 32);
    for (int n = 0; n < 100; ++n) look();
    EXPECT_EQ(::board.stalled_ms, std::fabs(share) < 1.0 ? 100 : 1) << share;
  }
}

// A run, or a command, begins from where the shaft is.
TEST_F(Stall, TheWayBeginsWhereTheReferenceDoes) {
  for (const int sign : {1, -1}) {
    SetUp();
    refer(0);
    for (int n = 0; n < 120; ++n) {
      inside::selected().angle_bam += static_cast<std::uint32_t>(sign * static_cast<std::int32_t>(kDegree));
      look();
    }
    refer(sign * 100);
    int n = 0;
    for (; n < 5000 && inside::state() == DRIVE_RUN; ++n) look();
    EXPECT_NEAR(n, 501, 2) << "what it was turned before is no way made";
  }
}

// More than a quarter of a turn between two looks: the angle alone would not tell which way.
TEST_F(Stall, ASpeedBeyondWhatTwoLooksTellIsNone) {
  inside::selected().speed_bpp = bpp_of(40000);
  for (int n = 0; n < 2000; ++n) look();
  EXPECT_EQ(inside::fault(), FAULT_NONE);
}

TEST_F(Stall, ZeroSwitchesItOff) {
  parameters.stall_time = 0;
  expect_none(0.0);
  parameters.stall_time = 500;
  SetUp();
  expect_stall(0.0);
}

// A shaft that makes half of its reference's way, or a quarter of an electrical turn in the time, is not stalled.
TEST_F(Stall, AShaftThatGetsOnIsNone) {
  expect_none(8.0);  // 96 degrees in the time, of the 1200 that the reference asks for
  expect_none(3000.0);
  refer(2);  // 24 degrees
  expect_none(1.1);
  SetUp();
  refer(2);
  expect_stall(0.9);
}

TEST_F(Stall, TheRestlessAngleOfABlockedShaftDoesNotHideIt) {
  int n = 0;
  for (; n < 5000 && inside::state() == DRIVE_RUN; ++n) {
    inside::selected().angle_bam =
        static_cast<std::uint32_t>(static_cast<std::int64_t>((n % 2 == 0 ? 3.5 : -3.5) * kDegree));
    look();
  }
  EXPECT_NEAR(n, 501, 2);
}

// The noise of the speed takes a blocked shaft off the limit now and then; it is found all the same.
TEST_F(Stall, AMomentOffTheLimitTakesFourBack) {
  EXPECT_EQ(looks_to_fault(0.0, 400), 400);
  inside::limits() = 0;
  look();
  inside::limits() = LIMIT_CURRENT;
  EXPECT_NEAR(looks_to_fault(0.0, 5000), 105, 2);
  EXPECT_EQ(inside::fault(), FAULT_STALL);
}

TEST_F(Stall, WhatIsTakenBackEndsAtNothing) {
  for (const auto& [before, after] : {std::pair{100, 96}, {5, 1}, {4, 0}, {3, 0}, {0, 0}}) {
    SetUp();
    for (int n = 0; n < before; ++n) look();
    ASSERT_EQ(::board.stalled_ms, before);
    inside::limits() = 0;
    look();
    EXPECT_EQ(::board.stalled_ms, after);
  }
}

TEST_F(Stall, OffTheLimitForAFifthOfTheTimeBeginsAnew) {
  EXPECT_EQ(looks_to_fault(0.0, 400), 400);
  inside::limits() = 0;
  for (int n = 0; n < 100; ++n) look();
  inside::limits() = LIMIT_CURRENT;
  expect_stall(0.0);
}

// A heavy shaft whose reference has changed its sign already: it slows down for longer than the time, then turns round.
TEST_F(Stall, AReversalIsNone) {
  for (const double direction : {1.0, -1.0}) {
    SetUp();
    refer(direction > 0 ? 1500 : -1500);
    double angle = 0.0;
    for (int n = 0; n < 10000; ++n) {
      const double rpm = direction * (-1500.0 + 0.3 * n);
      angle += rpm / 60.0 * 4.0 * 360.0 * 1e-3;
      inside::selected().angle_bam = static_cast<std::uint32_t>(static_cast<std::int64_t>(angle * kDegree));
      inside::selected().speed_bpp = rpm < 0 ? -bpp_of(int(-rpm)) : bpp_of(int(rpm));
      look();
      ASSERT_EQ(inside::fault(), FAULT_NONE) << rpm;
    }
  }
}

// What a shaft that is driven back slows down by in its ripple is no way made: a tenth of its speed, ten times a turn.
TEST_F(Stall, AShaftThatIsDrivenBackUnevenlyIsAFault) {
  double turns = 0.0;
  int n = 0;
  for (; n < 5000 && inside::state() == DRIVE_RUN; ++n) {
    const double rpm = std::min(100.0, n / 3.0) * (1.0 + 0.1 * std::sin(10.0 * 6.2831853 * turns));
    turns -= rpm / 60.0 * 1e-3;
    inside::selected().angle_bam = static_cast<std::uint32_t>(static_cast<std::int64_t>(turns * 4.0 * 4294967296.0));
    inside::selected().speed_bpp = -bpp_of(int(rpm));
    look();
  }
  EXPECT_EQ(inside::fault(), FAULT_STALL);
  EXPECT_LT(n, 4 * 500);
}

}  // namespace
}  // namespace stillspin::test

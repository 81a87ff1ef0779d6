// Safe hands: no motor that starts from a line somebody left behind, none that runs when nobody is there any more.

#include "tests/firmware/console.hpp"

extern "C" {
#include "firmware/api/comm_watchdog.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;
using stillspin::test::board;  // and not the drive's own

class ConsoleHands : public Console {
 protected:
  static constexpr int kLong = 50000, kShort = 49000;  // rounds, on either side of 5 s

  void SetUp() override {
    Console::SetUp();
    inside::be_in(DRIVE_READY);
  }
  /// What is said at once to a line that has stood for so many rounds.
  std::string after(const std::string& line, int rounds) {
    send(line);
    run(rounds);
    text.clear();
    send("\r");
    run(300);
    return text;
  }
  void start_hold() {
    (void)command("start hold", 100);
    ASSERT_TRUE(inside::start_requested());
    inside::withdraw_state();
    inside::be_in(DRIVE_RUN);
    run(300);
  }
  void serial_break() {
    board.serial_errors.breaks++;
    board.serial_break = static_cast<int>(board.serial_in.size());
  }
  const Octets kSession = little(0x80000001u, 4);
  static constexpr const char* kTooOld =
      "nothing done: typed over 5 s ago, or cut by a break. Arrow up recalls it\r\n> ";
};

TEST_F(ConsoleHands, ALineThatWasLeftDoesNotStartTheMotor) {
  NEEDS("commissioning");
  for (const char* line : {"start free", "start hold", "commission start free"}) {
    EXPECT_EQ(after(line, kLong), std::string("\r\n") + kTooOld) << line;
    EXPECT_FALSE(inside::start_requested() || inside::state_requested() != nullptr || comm_watchdog_is_on()) << line;
  }
  EXPECT_FALSE(has(after("start free", kShort), "typed over 5 s ago"));
  EXPECT_TRUE(inside::start_requested());
}

TEST_F(ConsoleHands, ASpeedExpiresWhileTheMotorRunsUnlessItIsZero) {
  EXPECT_TRUE(has(after("ref 50", kLong), "ref 50.00 rpm")) << "nothing moves yet";
  inside::be_in(DRIVE_RUN);
  EXPECT_TRUE(has(after("ref 60", kLong), "typed over 5 s ago"));
  EXPECT_EQ(drive_commanded_speed(), 50 * 65536);
  EXPECT_TRUE(has(after("ref 0", kLong), "ref 0.00 rpm"));
}

TEST_F(ConsoleHands, ALookExpiresWhileTheMotorRuns) {
  NEEDS("start/flying");
  inside::be_in(DRIVE_RUN);
  EXPECT_TRUE(has(after("look", kLong), "typed over 5 s ago"));
}

TEST_F(ConsoleHands, OtherLinesNeverExpire) {
  NEEDS("commissioning");
  EXPECT_TRUE(has(after("get speed_ramp", kLong), "speed_ramp = "));
  EXPECT_TRUE(has(after("set speed_ramp 250", 20 * kLong), "speed_ramp = 250 rpm/s"));
  EXPECT_TRUE(has(after("commission results", kLong), "commissioning: not yet"));
  inside::be_in(DRIVE_RUN);
  EXPECT_TRUE(has(after("stop", kLong), "stopping"));
  EXPECT_TRUE(inside::stop_requested());
}

// Once expired it stays expired: to complete somebody else's line is not to have typed it.
TEST_F(ConsoleHands, AnOldLineStaysOldUntilItIsEmptied) {
  send("start fre");
  run(kLong);
  EXPECT_TRUE(has(command("e"), "typed over 5 s ago"));
  EXPECT_FALSE(inside::start_requested());
  send("start fre");
  run(kLong);
  send("\x15");
  EXPECT_FALSE(has(command("start free", 300), "typed over 5 s ago"));
  EXPECT_TRUE(inside::start_requested());
}

TEST_F(ConsoleHands, AnOldLineThatWasTakenBackIsForgotten) {
  send("sta");
  run(kLong);
  send("\b\b\b");
  EXPECT_FALSE(has(command("start free", 300), "typed over 5 s ago"));
  EXPECT_TRUE(inside::start_requested());
}

TEST_F(ConsoleHands, TheArrowUpBringsAnOldLineBackAsANewOne) {
  (void)after("start free", kLong);
  (void)command("\x1B[A", 300);
  EXPECT_TRUE(inside::start_requested());
}

// Typed ahead during an answer, it is as old as when it came, not as when its turn came.
TEST_F(ConsoleHands, WhatIsTypedAheadIsAsOldAsItIs) {
  board.serial_room = 0;
  send("list\rstart free");
  for (int k = 0; k < kLong / 10; ++k) {
    inside::time_ms()++;
    board.serial_room = 300;  // for the console to take octets
    link_service();
    board.serial_room = 0;  // and none for the lines of the answer
    console_service();
    board.serial_out.clear();
  }
  send("\r");
  run(40000);
  EXPECT_TRUE(has(text, "typed over 5 s ago")) << text.substr(text.size() - 200);
  EXPECT_FALSE(inside::start_requested());
}

TEST_F(ConsoleHands, ABreakEmptiesTheLine) {
  send("start free");
  run(100);
  serial_break();
  EXPECT_EQ(command("", 300), "") << "an empty line";
  EXPECT_FALSE(inside::start_requested());
  send("re");
  run(100);
  serial_break();
  EXPECT_EQ(command("version"), kVersion) << "what is typed behind it counts";
}

// "help start free" with a break in it is no start; a line that is all there may be said again.
TEST_F(ConsoleHands, TheRestOfALineMovesNothing) {
  send("help ");
  run(100);
  serial_break();
  EXPECT_TRUE(has(command("start free", 300), "cut by a break"));
  EXPECT_FALSE(inside::start_requested());
  EXPECT_FALSE(has(command("start free", 300), "cut by a break"));
  EXPECT_TRUE(inside::start_requested());
}

// The break is counted by the interrupt, the octets are read in rounds: those before it and behind it in one.
TEST_F(ConsoleHands, ABreakStandsWhereItCameAmongTheOctets) {
  send("start free\r");
  serial_break();
  EXPECT_EQ(command("get speed_ramp", 300).substr(0, 10), "speed_ramp");
  EXPECT_FALSE(inside::start_requested());
  serial_break();
  EXPECT_FALSE(has(command("start free", 300), "nothing done")) << "nothing was cut";
  EXPECT_TRUE(inside::start_requested());
}

TEST_F(ConsoleHands, ABreakLeavesWhatWasTypedBehindItDuringALongAnswer) {
  send("list\rref 70\r");
  run(100);
  serial_break();
  send("ref 50\r");
  run(40000);
  EXPECT_EQ(drive_commanded_speed(), 50 * 65536);
  EXPECT_FALSE(has(text, "ref 70"));
}

TEST_F(ConsoleHands, ABreakEndsARecordThatWasBegun) {
  send(Octets{0, 'a', 'b'});
  run(3);
  serial_break();
  EXPECT_EQ(command("version"), kVersion);
}

TEST_F(ConsoleHands, ABreakForgetsWhatWasTypedAhead) {
  send("list\rref 70\r");
  run(100);
  serial_break();
  run(30000);
  EXPECT_EQ(drive_commanded_speed(), 0);
  EXPECT_EQ(command("ref 50"), "ref 50.00 rpm\r\n");
}

TEST_F(ConsoleHands, AStartNeedsAGuardOrTheWordThatItNeedsNone) {
  NEEDS("commissioning");
  const std::string ways =
      "nothing done: nobody would watch. Add 'hold' (while a key is held) or 'free' (until 'stop')\r\n";
  for (const char* line : {"start", "commission start", "start now", "start hold free", "commission start hold 1"}) {
    EXPECT_EQ(command(line), ways) << line;
  }
  EXPECT_FALSE(inside::start_requested() || inside::state_requested() != nullptr);
}

TEST_F(ConsoleHands, FreeSaysWhatItMeans) {
  EXPECT_TRUE(
      has(command("start free", 100), "free: nobody watches; it runs until 'stop', even without this terminal"));
  EXPECT_TRUE(inside::start_requested());
  EXPECT_FALSE(comm_watchdog_is_on());
  inside::withdraw_state();
  inside::be_in(DRIVE_RUN);
  run(100000);
  EXPECT_FALSE(inside::stop_requested()) << "and means it";
}

TEST_F(ConsoleHands, HeldItRunsAsLongAsKeysComeAndStopsWithTheLast) {
  start_hold();
  for (int k = 0; k < 20; ++k) {
    run(9000);
    send(k % 2 == 0 ? "\r" : "x");
    run(10);
    ASSERT_FALSE(inside::stop_requested()) << k;
  }
  run(9000);
  EXPECT_FALSE(inside::stop_requested());
  text.clear();
  run(1500);
  EXPECT_TRUE(inside::stop_requested());
  EXPECT_TRUE(has(text, "\r\n! nothing was heard for link_timeout: the motor stops\r\n")) << text;
  text.clear();
  run(20000);
  EXPECT_EQ(text, "") << "once";
}

// A cable that hangs loose is no hand.
TEST_F(ConsoleHands, OctetsThatNoKeySendsDoNotHold) {
  start_hold();
  for (int k = 0; k < 12; ++k) {
    const Octets octets = {0xFF, 0x80, 0};
    send(Octets{octets[std::size_t(k % 3)]});
    run(1000);
  }
  EXPECT_TRUE(inside::stop_requested());
}

TEST_F(ConsoleHands, ALetGoMotorCoastsWhenThatIsTheReaction) {
  parameters.link_reaction = LINK_REACTION_COAST;
  start_hold();
  run(11000);
  EXPECT_TRUE(inside::coast_requested());
}

TEST_F(ConsoleHands, RecordsDoNotHoldWhatKeysHold) {
  start_hold();
  for (int k = 0; k < 12; ++k) {
    (void)ask(REQUEST_STATUS, kSession);
    run(600);
  }
  EXPECT_TRUE(inside::stop_requested());
}

// The space bar is the key to hold: it leaves the line empty and an answer that goes on alone.
TEST_F(ConsoleHands, TheSpaceBarHoldsAndNothingElse) {
  start_hold();
  send("watch speed\r");
  run(100);
  text.clear();
  for (int k = 0; k < 300; ++k) {
    send(" ");
    run(300);
  }
  EXPECT_FALSE(inside::stop_requested());
  EXPECT_GE(std::count(text.begin(), text.end(), '\n'), 15) << text;
  EXPECT_FALSE(has(text, "> "));
  send("stop\r");
  run(100);
  EXPECT_TRUE(inside::stop_requested());
}

TEST_F(ConsoleHands, ASpaceIsASpaceWhenNobodyHolds) {
  (void)command("start free", 100);
  inside::be_in(DRIVE_RUN);
  send("watch\r");
  run(300);
  text.clear();
  send(" ");
  run(300);
  EXPECT_EQ(text, ">  ") << "any key ends a watch and is the next line's first";
  send("get  speed_ramp");
  run(100);
  EXPECT_TRUE(has(text, "get  speed_ramp"));
}

TEST_F(ConsoleHands, RecordsOfASessionGuardABareStart) {
  (void)ask(REQUEST_STATUS);
  EXPECT_TRUE(has(command("start", 300), "nobody would watch")) << "who only looks holds nothing";
  (void)ask(REQUEST_STATUS, kSession);
  EXPECT_EQ(command("start", 100), "");
  EXPECT_TRUE(inside::start_requested());
  inside::withdraw_state();
  inside::be_in(DRIVE_RUN);
  for (int k = 0; k < 30; ++k) {
    (void)ask(REQUEST_STATUS, kSession);
    run(5000);
  }
  EXPECT_FALSE(inside::stop_requested());
  for (int k = 0; k < 20; ++k) {  // the terminal has died, the next session is there at once
    (void)ask(REQUEST_STATUS, little(4711, 4));
    run(200);
  }
  EXPECT_TRUE(inside::stop_requested());
}

TEST_F(ConsoleHands, ASessionThatWasThereIsNoGuard) {
  NEEDS("commissioning");
  (void)ask(REQUEST_STATUS, kSession);
  run(9000);
  EXPECT_FALSE(has(command("commission start", 100), "nobody would watch"));
  (void)command("stop");
  inside::withdraw_state();
  (void)ask(REQUEST_STATUS, kSession);
  run(10500);
  EXPECT_TRUE(has(command("commission start", 100), "nobody would watch"));
}

TEST_F(ConsoleHands, WhoLeavesMayLetGoOfAMotorThatRuns) {
  start_hold();
  EXPECT_TRUE(has(command("start free", 100), "free: nobody watches"));
  run(30000);
  EXPECT_FALSE(inside::stop_requested());
}

// What others hold they let go of themselves; the answer says so.
TEST_F(ConsoleHands, NobodyLetsGoOfWhatTheBusOrTheSwitchHolds) {
  const std::string others = "the CAN bus or the board's switch holds the motor: nothing changed\r\n";
  inside::be_in(DRIVE_RUN);
  comm_watchdog_begin(COMM_WATCHDOG_BUS, 7);
  EXPECT_EQ(command("start free", 100), others);
  EXPECT_TRUE(comm_watchdog_is_on());
  comm_watchdog_begin(COMM_WATCHDOG_OWN, 0);
  EXPECT_EQ(command("start free", 100), others);
  run(50000);
  EXPECT_FALSE(inside::stop_requested()) << "they do not speak through it";
}

}  // namespace

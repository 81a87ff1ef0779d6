// A look at the shaft that is no start: two short pulses, and back to ready with what they showed.

#include "tests/firmware/requests.hpp"
#include "tests/firmware/start_caught.hpp"

extern "C" {
#include "firmware/api/actions.h"
#include "firmware/mode/commands.h"
#include "firmware/start/flying/look.h"
}

namespace {

using namespace stillspin::test;

class Look : public StartCaught {
 protected:
  void SetUp() override {
    NEEDS("start/flying");
    Drive::SetUp();
    use_source(0);
    make_ready();
    look();
  }
  void look() {
    drive_command_look();
    EXPECT_EQ(drive_look_outcome(), LOOK_RUNNING) << "asked for, and not begun yet";
    period();
    ASSERT_EQ(inside::state(), DRIVE_START);
    EXPECT_EQ(drive_look_outcome(), LOOK_RUNNING);
  }
  static double rpm() { return real(drive_look_rpm(), 16); }
  static void expect_ready() {
    EXPECT_EQ(inside::state(), DRIVE_READY);
    EXPECT_EQ(inside::fault(), FAULT_NONE);
    EXPECT_FALSE(board.gates_on);
    EXPECT_FALSE(drive_is_energised());
  }
};

TEST_F(Look, APairOfPulsesGivesTheSpeed) {
  for (const double speed : {300.0, -300.0}) {
    SetUp();
    catch_at(speed, 1.0);
    expect_ready();
    EXPECT_EQ(drive_look_outcome(), LOOK_TURNS);
    EXPECT_NEAR(rpm(), speed / Motor{}.pole_pairs * 30.0 / kPi, 3.0);
  }
}

TEST_F(Look, AnEmfBelowThreeVoltsIsAShaftThatStandsOrCrawls) {
  await_pulse();
  see_pulse(0.5, 2.9);
  expect_ready();
  EXPECT_EQ(drive_look_outcome(), LOOK_STANDS);
  EXPECT_NEAR(rpm(), 3.0 / Motor{}.flux / Motor{}.pole_pairs * 30.0 / kPi, 1.0) << "the most that it may turn at";
}

// No fault, as it is for a start: nobody wants to run.
TEST_F(Look, PairsThatDoNotFitAreNoFault) {
  for (int pulse = 0; pulse < 8; ++pulse) {
    ASSERT_EQ(inside::state(), DRIVE_START) << pulse;
    await_pulse();
    see_pulse(0.5, 48.0);
  }
  expect_ready();
  EXPECT_EQ(drive_look_outcome(), LOOK_UNCLEAR);
}

TEST_F(Look, WhatBreaksItOffEndsIt) {
  drive_command_stop();
  period();
  expect_ready();
  EXPECT_EQ(drive_look_outcome(), LOOK_ENDED);
  look();
  drive_command_coast();
  period();
  expect_ready();
  EXPECT_EQ(drive_look_outcome(), LOOK_ENDED);
  look();
  drive_trip(&drive, FAULT_LINK_LOW);
  EXPECT_EQ(drive_look_outcome(), LOOK_ENDED);
}

// What forbids a start forbids a look.
TEST_F(Look, AnEmergencyStopForbidsIt) {
  drive_command_coast();
  period();
  parameters.emergency_stop = 1;
  use_parameters();
  board.emergency = true;
  drive_command_look();
  period();
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(drive_look_outcome(), LOOK_ENDED);
}

// A start that is under way is none.
TEST_F(Look, AStartBehindItIsNotTakenForIt) {
  drive_command_stop();
  period();
  drive_command_start();
  period();
  ASSERT_EQ(inside::state(), DRIVE_START);
  EXPECT_EQ(drive_look_outcome(), LOOK_ENDED);
}

// And nothing is begun that is asked for while the drive runs.
TEST_F(Drive, OneThatRunsDoesNotLook) {
  NEEDS("start/flying");
  make_run();
  drive_command_look();
  period();
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_EQ(drive_look_outcome(), LOOK_ENDED);
}

class LookAsked : public Requests {
 protected:
  void SetUp() override {
    NEEDS("start/flying");
    Requests::SetUp();
    inside::loading() = false;
    inside::be_in(DRIVE_READY);
    run(10);
  }
  static void show(look_outcome_t outcome, int rpm) {
    inside::withdraw_state();
    drive_look_end(outcome, rpm * 65536);
  }
};

TEST_F(LookAsked, TheConsoleWaitsForWhatItShows) {
  const struct {
    look_outcome_t outcome;
    const char* words;
    const char* speed;
  } cases[] = {{LOOK_TURNS, "turns", "300 rpm"}, {LOOK_STANDS, "stands", "300 rpm"}, {LOOK_UNCLEAR, "", "300 rpm"}};
  for (const auto& c : cases) {
    EXPECT_EQ(command("look", 300), "") << "the pulses are under way";
    ASSERT_NE(inside::state_requested(), nullptr);
    EXPECT_EQ(inside::state_requested()->behind, DRIVE_READY);
    show(c.outcome, 300);
    text.clear();
    run(300);
    EXPECT_NE(text.find(c.words), std::string::npos) << text;
    EXPECT_NE(text.find(c.speed), std::string::npos) << text;
  }
}

TEST_F(LookAsked, OneThatWasBrokenOffHasNoSpeed) {
  (void)command("look", 300);
  show(LOOK_RUNNING, 300);  // no outcome, and no request
  text.clear();
  run(300);
  EXPECT_EQ(text.find("rpm"), std::string::npos) << text;
  EXPECT_NE(text.find("ended"), std::string::npos) << text;
}

TEST_F(LookAsked, IsRefusedWhereAStartIs) {
  EXPECT_NE(command("look twice"), "");
  EXPECT_EQ(inside::state_requested(), nullptr) << "it has no arguments";
  inside::be_in(DRIVE_RUN);
  EXPECT_NE(command("look").find("busy"), std::string::npos);
  EXPECT_EQ(inside::state_requested(), nullptr);
}

TEST_F(LookAsked, AMachineReadsTheSame) {
  show(LOOK_TURNS, -120);
  const Answer answer = ask(REQUEST_LOOK);
  ASSERT_EQ(answer.status(), OK);
  EXPECT_EQ(answer.number(0, 1), LOOK_TURNS);
  EXPECT_EQ(static_cast<std::int32_t>(answer.number(1, 4)), -120 * 65536);
  EXPECT_NE(answer.text(5).find("-120 rpm"), std::string::npos) << answer.text(5);
  show(LOOK_NONE, 0);
  EXPECT_EQ(ask(REQUEST_LOOK).text(5), "no look since power-on");
}

}  // namespace

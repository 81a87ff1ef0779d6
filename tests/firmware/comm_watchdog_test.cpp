// A drive that was started guarded stops by itself when who has started it is silent, whoever else speaks.

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "tests/firmware/requests.hpp"

namespace {

using namespace stillspin::test;

class CommWatchdog : public Requests {
 protected:
  void SetUp() override {
    Requests::SetUp();
    inside::be_in(DRIVE_READY);
    parameters.link_timeout = 200;
  }
  static constexpr std::int32_t kMine = 0x12345, kOthers = 0x12347;
  Answer tell(std::int32_t number) { return ask(REQUEST_STATUS, little(static_cast<std::uint32_t>(number), 4)); }
  void start(std::int32_t argument) {
    ASSERT_EQ(give(COMMAND_START, argument).status(), OK);
    inside::withdraw_state();
    inside::be_in(DRIVE_RUN);
  }
};

TEST_F(CommWatchdog, SilenceStopsTheDrive) {
  start(kMine);
  for (int k = 0; k < 8; ++k) {
    run(1000);
    EXPECT_EQ(tell(kMine).number(22, 1), 5u) << "on, and of who asks";
  }
  EXPECT_FALSE(inside::stop_requested());
  run(1500);
  EXPECT_FALSE(inside::stop_requested());
  run(600);
  EXPECT_TRUE(inside::stop_requested());
  EXPECT_EQ(ask(REQUEST_STATUS).number(22, 1), 2u) << "and it says so";
}

TEST_F(CommWatchdog, AFaultEndsItBeforeTheStartWasCarriedOut) {
  ASSERT_EQ(give(COMMAND_START, kMine).status(), OK);
  EXPECT_EQ(ask(REQUEST_STATUS).number(22, 1), 1u);
  inside::be_in(DRIVE_FAULT);
  EXPECT_EQ(ask(REQUEST_STATUS).number(22, 1), 0u);
  inside::be_in(DRIVE_RUN);  // reset and started by somebody else
  run(3000);
  EXPECT_FALSE(inside::stop_requested());
}

TEST_F(CommWatchdog, ItCanBeToldToCoast) {
  parameters.link_reaction = LINK_REACTION_COAST;
  start(kMine);
  run(2500);
  EXPECT_TRUE(inside::coast_requested());
  EXPECT_FALSE(inside::stop_requested());
}

TEST_F(CommWatchdog, WithoutItSilenceIsNothing) {
  start(0);
  run(5000);
  EXPECT_FALSE(inside::stop_requested() || inside::coast_requested());
}

TEST_F(CommWatchdog, ItIsAskedForWithTheLowestBit) {
  NEEDS("commissioning");
  start(~1);
  EXPECT_FALSE(comm_watchdog_is_on());
  inside::be_in(DRIVE_READY);
  ASSERT_EQ(give(COMMAND_COMMISSION, ~1).status(), OK);
  EXPECT_FALSE(comm_watchdog_is_on());
  ASSERT_EQ(give(COMMAND_COMMISSION, kMine).status(), OK);
  EXPECT_TRUE(comm_watchdog_is_on()) << "a commissioning turns the motor, too";
}

// Whoever asks meanwhile: one that only looks, and one that holds something of its own.
TEST_F(CommWatchdog, OtherClientsKeepNothingAlive) {
  start(kMine);
  for (int k = 0; k < 30; ++k) {
    EXPECT_EQ(tell(kOthers).number(22, 1) & 4u, 0u);
    (void)ask(REQUEST_SIGNALS, {0, 0});
    (void)ask(REQUEST_STATUS);
  }
  EXPECT_TRUE(inside::stop_requested());
}

TEST_F(CommWatchdog, AnotherClientThatGoesStopsNothing) {
  start(kMine);
  (void)tell(kOthers);
  for (int k = 0; k < 30; ++k) {
    run(1000);
    (void)tell(kMine);
  }
  EXPECT_FALSE(inside::stop_requested());
}

TEST_F(CommWatchdog, AFormerClientIsToldWhyItMayNotStart) {
  NEEDS("commissioning");
  for (const unsigned code : {COMMAND_START, COMMAND_COMMISSION}) {
    EXPECT_EQ(give(code, 1).status(), RANGE);
    EXPECT_EQ(give(code, 1).text(), "a guarded start needs the client's number: this client is too old");
  }
  EXPECT_FALSE(inside::start_requested() || inside::state_requested() != nullptr);
  EXPECT_EQ(give(COMMAND_SPEED, 1).status(), OK) << "of which the lowest bit says nothing";
  for (int octets = 1; octets < 4; ++octets) EXPECT_EQ(ask(REQUEST_STATUS, little(1, octets)).status(), LENGTH);
}

// From the last record on, and no earlier; then it has done its work.
TEST_F(CommWatchdog, SilenceIsAsLongAsToldAndEndsItOnce) {
  const auto stops_at = [](std::uint32_t ms) {
    inside::withdraw_stop();
    inside::time_ms() = ms;
    comm_watchdog_service();
    return inside::stop_requested();
  };
  inside::be_in(DRIVE_RUN);
  inside::time_ms() = 1000;
  comm_watchdog_begin(COMM_WATCHDOG_BUS, 7);
  EXPECT_FALSE(stops_at(1199));
  comm_watchdog_heard(COMM_WATCHDOG_BUS, 7);
  EXPECT_FALSE(stops_at(1398));
  EXPECT_TRUE(stops_at(1399));
  EXPECT_TRUE(comm_watchdog_has_stopped());
  EXPECT_FALSE(comm_watchdog_is_on() || stops_at(9999));
  comm_watchdog_begin(COMM_WATCHDOG_BUS, 7);
  EXPECT_FALSE(comm_watchdog_has_stopped()) << "since the last start";
  inside::be_in(DRIVE_READY);
  EXPECT_TRUE(stops_at(20000)) << "a start that was not carried out yet is taken back";
  EXPECT_FALSE(comm_watchdog_has_stopped());
  comm_watchdog_begin(COMM_WATCHDOG_BUS, 7);
  inside::be_in(DRIVE_RUN);
  comm_watchdog_reset();
  EXPECT_FALSE(comm_watchdog_is_on() || stops_at(30000));
}

TEST_F(CommWatchdog, OnlyThePortThatStartedCounts) {
  start(kMine);
  std::uint16_t answer[RECORD_MAX];
  const std::uint16_t request[] = {REQUEST_STATUS, 7, 0x45, 0x23, 0x01, 0};
  for (int k = 0; k < 30; ++k) {
    run(100);
    (void)request_answer(COMM_WATCHDOG_BUS, request, 6, answer);
    send("\r");  // nor does text
  }
  EXPECT_TRUE(inside::stop_requested());
}

TEST_F(CommWatchdog, ItEndsWithThePowerStage) {
  start(kMine);
  run(10);
  inside::be_in(DRIVE_READY);
  run(10);
  inside::be_in(DRIVE_RUN);  // started by someone else, without it
  run(5000);
  EXPECT_FALSE(inside::stop_requested());
}

}  // namespace

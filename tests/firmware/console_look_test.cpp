// What a person looks at: status, signals, faults, the bus, a commissioning.

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/console.hpp"

extern "C" {
#include "estimators/wiring.h"
#include "firmware/can/command.h"
#include "firmware/can/messages.h"
#include "firmware/can/node.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/console/output.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/states.h"
#include "firmware/start/step.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

TEST_F(Console, StatusAndFaults) {
  EXPECT_EQ(command("faults"), "no fault since power-on\r\n");
  EXPECT_EQ(command("reset"), "no fault is latched\r\n");
  inside::be_in(DRIVE_RUN);
  inside::time_ms() += 12000;
  drive_trip(&drive, FAULT_SYNCHRONISM);
  const std::string faults = command("faults");
  EXPECT_TRUE(has(faults, "1 since power-on, which was 12 s ago")) << faults;
  EXPECT_TRUE(has(faults, " s  loss of synchronism, running at 0.0 rpm, link ")) << faults;
  const std::string status = command("status");
  EXPECT_TRUE(has(status, "state       fault\r\n")) << status;
  EXPECT_TRUE(has(status, "fault       loss of synchronism. reduce load")) << status;
  EXPECT_TRUE(has(status, "is a motor wire broken? the next start names it\r\n")) << status;
  EXPECT_TRUE(has(status, "parameters  fit together"));
  EXPECT_TRUE(has(command("start free"), "reset it first: loss of synchronism"));
  EXPECT_TRUE(has(command("reset"), "cleared"));
}

TEST_F(Console, StatusSaysWhatHoldsTheDriveBack) {
  inside::limits() = LIMIT_CURRENT;
  inside::be_in(DRIVE_READY);
  EXPECT_TRUE(has(command("status"), "limits      none\r\n")) << "of when the power stage was on";
  inside::be_in(DRIVE_RUN);
  EXPECT_TRUE(has(command("status"), "limits      current limit\r\n"));
  inside::limits() = LIMIT_VOLTAGE | LIMIT_BRAKING;
  EXPECT_TRUE(has(command("status"), "limits      voltage limit, braking reduced by the DC link\r\n"));
}

TEST_F(Console, StatusSaysHowFarAProcedureIs) {
  NEEDS("commissioning");
  inside::be_in(DRIVE_COMMISSION);
  commissioning.phase = COMMISSIONING_SPIN;
  inside::start_phase() = START_CHARGE;
  EXPECT_TRUE(has(command("status"), "state       commissioning: spin: flux linkage, inertia, friction\r\n"));
  inside::be_in(DRIVE_START);
  EXPECT_TRUE(has(command("status"), "state       starting: charging the bootstrap capacitors\r\n"));
}

TEST_F(Console, StatusSaysWhyParametersDoNotFitTogether) {
  NEEDS("store");
  parameters.if_current = parameters.current_limit + 1;
  parameters.start_method = 1;
  inside::request_reload();
  EXPECT_TRUE(has(command("status"),
                  "parameters  if_current must not exceed current_limit with start_method 1 (if_current = "
                  "14.00 A, current_limit = 14.00 A, start_method = 1); 3 of the parameters not saved"));
}

TEST_F(Console, GetSaysWhatMayNotChangeWhileItRuns) {
  EXPECT_TRUE(has(command("get speed_limit"), "only while the power stage is off"));
  EXPECT_FALSE(has(command("get pulse_time"), "only while"));
}

TEST_F(Console, Signals) {
  const std::string all = command("signals", 10000);
  for (std::uint16_t k = 0; k < signal_count(); ++k) {
    EXPECT_EQ(has(all, bench::text_of(signal_info(k)->name) + ' '), !signal_is_left_out(k));
  }
  inside::be_in(DRIVE_RUN);
  inside::selected().speed_bpp = (bpp_of(600) + bpp_of(601)) / 2;
  EXPECT_TRUE(has(command("signals mechanical"), "600.50 rpm"));
}

// With the power stage off the estimators go on, and what they make of nothing is no speed.
TEST_F(Console, WhatIsUnknownIsSaidInWords) {
  inside::be_in(DRIVE_READY);
  inside::selected().speed_bpp = bpp_of(25);
  inside::current_dq_q20() = {1 << 20, -5 * (1 << 20)};
  inside::command_rpm_q16() = 600 * 65536;
  inside::window_count() = 1;
  inside::windows()[0].current_q20 = {raw(0.02, 20), raw(-0.0346, 20)};
  std::string said = command("status", 3000);
  EXPECT_TRUE(has(said, "state       ready\r\n")) << said;
  EXPECT_TRUE(has(said, "speed       unknown, the shaft may be turning; reference 600.0 rpm\r\n")) << said;
  EXPECT_TRUE(has(said, "current     phase a 0.02 A, phase b -0.04 A\r\n")) << said;
  inside::window_count() = 0;
  EXPECT_TRUE(
      has(command("watch", 300), "ready   unknown, the shaft may be turning; reference 600.0 rpm   phase a 0.00"));
  EXPECT_TRUE(has(command("watch speed current_q", 300), "\nspeed unknown   current_q unknown\r\n"));
  EXPECT_TRUE(has(command("get angle"), "angle                 unknown           electrical angle"));
  EXPECT_TRUE(has(command("get speed_known"), "speed_known           0 "));
  drive_trip(&drive, FAULT_OFFSET);
  said = command("faults");
  EXPECT_TRUE(has(said, "current offset implausible, ready, speed unknown, link 0.0 V\r\n")) << said;
}

TEST_F(Console, WatchGoesOnUntilAKey) {
  inside::be_in(DRIVE_RUN);
  send("watch\r");
  run(16000);
  EXPECT_TRUE(has(text, "running   0.0 rpm of 0.0 rpm"));
  send("stop\r");
  run(300);
  EXPECT_TRUE(inside::stop_requested()) << "the key that ends it belongs to the next command";
  text.clear();
  run(10000);
  EXPECT_EQ(text, "");
}

TEST_F(Console, WatchShowsTheSignalsThatAreNamed) {
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {1 << 20, -5 * (1 << 20)};
  EXPECT_EQ(command("watch current_q", 300), "current_q -5.000 A\r\n");
  EXPECT_TRUE(
      has(command("watch current_q fault current_d", 300), "current_q -5.000 A   fault 0   current_d 1.000 A\r\n"));
  EXPECT_FALSE(has(text, "rpm of"));
}

TEST_F(Console, WatchShowsFourSignalsAtMost) {
  inside::be_in(DRIVE_RUN);
  EXPECT_TRUE(has(command("watch state fault limit speed", 300), "state 4   fault 0   limit 0   speed 0.00 rpm\r\n"));
  EXPECT_TRUE(has(command("watch state fault limit speed angle", 300), "at most four signals"));
}

TEST_F(Console, WatchSaysWhatHoldsTheDriveBack) {
  EXPECT_FALSE(has(command("watch", 300), " V   "));
  inside::be_in(DRIVE_RUN);
  inside::limits() = LIMIT_CURRENT | LIMIT_WEAKENING;
  EXPECT_TRUE(has(command("watch", 300), " V   current limit, field weakening\r\n"));
}

TEST_F(Console, ALineThatHasNoRoomForAllOfItSaysSo) {
  NEEDS("commissioning");
  inside::be_in(DRIVE_COMMISSION);
  commissioning.phase = COMMISSIONING_STAIRCASE;
  inside::limits() = LIMIT_CURRENT | LIMIT_VOLTAGE | LIMIT_WEAKENING | LIMIT_OVERRUN | LIMIT_BRAKING;
  const std::string line = command("watch", 300);
  EXPECT_EQ(line.size(), TEXT_LINE_MAX);
  EXPECT_EQ(line.substr(line.size() - 5), "...\r\n");
  inside::be_in(DRIVE_RUN);
  EXPECT_FALSE(has(command("watch", 300), "..."));
}

TEST_F(Console, StatusNamesTheWiringBehindItsFault) {
  NEEDS("start/flying");
  inside::be_in(DRIVE_RUN);
  drive_trip(&drive, FAULT_OPEN_PHASE);
  inside::wiring() = WIRING_OPEN_B;
  const std::string named = command("status");
  EXPECT_TRUE(has(named, ": " + bench::words_of(CATALOGUE_WIRING, WIRING_OPEN_B) + ". ")) << named;
  inside::wiring() = WIRING_GOOD;
  const std::string plain = command("status");
  EXPECT_FALSE(has(plain, bench::words_of(CATALOGUE_WIRING, WIRING_GOOD))) << plain;
  inside::wiring() = WIRING_OPEN_B;
  inside::fault() = FAULT_SYNCHRONISM;
  EXPECT_FALSE(has(command("status"), bench::words_of(CATALOGUE_WIRING, WIRING_OPEN_B))) << "found by an earlier start";
}

TEST_F(Console, StatusSaysThatTheLastSaveFailed) {
  NEEDS("store");
  nvm.absent = true;
  (void)command("save", 3000);
  ASSERT_EQ(store_state(), STORE_FAILED);
  EXPECT_TRUE(has(command("status", 3000), "the last save failed"));
}

TEST_F(Console, Commissioning) {
  NEEDS("commissioning");
  EXPECT_EQ(command("commission"), "commissioning: not yet\r\n");
  EXPECT_EQ(command("commission results"), "commissioning: not yet\r\n");
  EXPECT_TRUE(has(command("commission now"), "commission start"));
  EXPECT_TRUE(has(command("commission start free"), "not ready"));
  inside::be_in(DRIVE_READY);
  EXPECT_TRUE(has(command("commission start free"), "the shaft will turn"));
  ASSERT_NE(inside::state_requested(), nullptr);
  EXPECT_EQ(inside::state_requested()->state, DRIVE_COMMISSION);
}

TEST_F(Console, ACommissioningUnderWayIsToldWithItsPhase) {
  NEEDS("commissioning");
  commissioning.outcome = COMMISSIONING_RUNNING;
  commissioning.phase = COMMISSIONING_EVALUATE;
  EXPECT_EQ(command("commission"), "commissioning: under way, 100 %: evaluation\r\n");
  commissioning.outcome = COMMISSIONING_ABORTED;
  EXPECT_FALSE(has(command("commission"), "evaluation"));
  parameters.inertia++;
  EXPECT_FALSE(has(command("commission"), "not saved"));
  commissioning.outcome = COMMISSIONING_DONE;
  EXPECT_TRUE(has(command("commission"), "not saved"));
}

TEST_F(Console, ResultsOfACommissioningAreListedUntilTheNextOneBegins) {
  NEEDS("commissioning");
  commissioning.evaluate = true;  // and nothing was measured
  commissioning_service(&drive);
  ASSERT_EQ(commissioning.outcome, COMMISSIONING_PARTLY);
  const std::int32_t before = parameters.inertia;
  parameters.inertia++;
  EXPECT_TRUE(has(command("commission"), "; 2 of the parameters not saved: 'save' keeps them\r\n"));
  parameters.inertia = before;
  std::string rows = command("commission results", 20000);
  rows.erase(0, rows.find('\n') + 1);  // how far it is, as `commission` says it
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), drive_commissioning_count());
  EXPECT_TRUE(has(rows, "\r\nmap_known             0 -> 1   ")) << rows;
  EXPECT_EQ(rows.rfind("stator_resistance     0.3200 -> -0.0350 ohm ", 0), 0u) << rows;
  EXPECT_TRUE(has(rows, "not measured: too few usable periods"));
  send("commission results\r");
  run(250);
  commissioning_state.begin(&drive, DRIVE_READY);
  text.clear();
  run(20000);
  EXPECT_EQ(text, "> ");
}

TEST_F(Console, TheBusInWords) {
  NEEDS("can");
  can_node_reset(nullptr);
  EXPECT_TRUE(has(command("can"), ": on the bus\r\n"));
  can_node_service();
  board.can_status = {HAL_CAN_BUS_OFF, 255, 3, 9, 2, 1};
  EXPECT_EQ(command("can"),
            "bus         node 1 at 500 kbit/s: bus-off: tries again after can_recovery\r\n"
            "errors      255 sending, 3 receiving (96 is a warning, 256 sending is bus-off); bus-off 2 times, "
            "restarted 1 times\r\n"
            "lost        9 frames or records; 0 commands rejected\r\n"
            "commands    none received\r\n");
}

TEST_F(Console, WhoCommandsOverTheBus) {
  NEEDS("can");
  can_node_reset(nullptr);
  std::uint16_t alive = 0;
  const auto come = [&](std::int32_t mode) {
    hal_can_frame_t f = can_frame(CAN_COMMAND, 1);
    can_put(&f, CAN_COMMAND_MODE, mode);
    can_put(&f, CAN_COMMAND_ALIVE, ++alive);
    can_put(&f, CAN_COMMAND_CRC, can_crc8(&f, 3));
    board.can_in[0].push_back(f);
    can_node_service();
  };
  inside::be_in(DRIVE_READY);
  come(CAN_MODE_OFF);
  EXPECT_TRUE(has(command("can"), "commands    received, but the drive was not started by them\r\n"));
  come(CAN_MODE_RUN);
  EXPECT_TRUE(has(command("can"), "commands    in command of the drive\r\n"));
  inside::time_ms() += static_cast<std::uint32_t>(parameters.can_timeout);
  can_node_service();
  EXPECT_TRUE(has(command("can"), "commands    missing (can_timeout)\r\n"));
}

}  // namespace

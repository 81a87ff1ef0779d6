// Whole lines as a person reads them: every number with its unit and in its column.

#include <algorithm>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/console.hpp"

extern "C" {
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/console/commands.h"
#include "firmware/console/signal_text.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/states.h"
#include "firmware/scope/scope.h"
#include "firmware/store/actions.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

class ConsoleLines : public Console {
 protected:
  /// Spaces up to a column.
  static std::string to(std::string text, std::size_t column) {
    text.resize(std::max(column, text.size() + 1), ' ');
    return text;
  }
  static long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

  static void at_work() {
    inside::be_in(DRIVE_RUN);
    inside::selected().speed_bpp = (bpp_of(600) + bpp_of(601)) / 2;
    inside::command_rpm_q16() = raw(-712.3, 16);
    inside::link_q16() = raw(287.6, 16);
    inside::current_dq_q20() = {raw(1.234, 20), raw(-5.678, 20)};
  }
};

TEST_F(ConsoleLines, AHelpRowHasNameArgumentsAndWhatItIs) {
  NEEDS("commissioning", "store", "scope", "can");
  const std::string help = command("help");
  std::string expected;
  for (std::uint16_t k = 0; command_name(k) != PACKED_NONE; ++k) {
    const auto piece = [k](int first) { return bench::text_of(static_cast<packed_text_t>(first + k)); };
    const std::string row = to(piece(TEXT_COMMAND_NAME_help) + " " + piece(TEXT_COMMAND_ARGUMENTS_help), 26) +
                            piece(TEXT_COMMAND_help) + "\r\n";
    EXPECT_EQ(command("help " + piece(TEXT_COMMAND_NAME_help)).rfind(row, 0), 0u) << row;
    expected += row;
  }
  EXPECT_EQ(help, expected + "Ctrl-C ends a long answer; stop and coast always work. More: help <command>\r\n");
}

TEST_F(ConsoleLines, HelpOfOneCommandIsAllThatIsSaidOfIt) {
  NEEDS("scope");
  EXPECT_EQ(lines(command("help set")), 1 + 3);
  EXPECT_EQ(lines(command("help scope")), 1 + 7);
  EXPECT_EQ(lines(command("help can")), 1);
  EXPECT_EQ(command("help cam").rfind("there is no command 'cam': ", 0), 0u);
}

TEST_F(ConsoleLines, StatusInNumbers) {
  NEEDS("store");
  at_work();
  board.serial_errors = {1, 20, 300, 4000};
  const std::string status = command("status");
  EXPECT_EQ(status.rfind("state       running\r\n"
                         "speed       600.5 rpm of -712.3 rpm\r\n"
                         "current     d 1.23 A, q -5.68 A\r\n"
                         "DC link     287.6 V\r\n"
                         "limits      none\r\n"
                         "fault       none\r\n",
                         0),
            0u)
      << status;
  EXPECT_TRUE(has(status, "\r\nstore       nothing has been saved yet: defaults are in force; saves so far 0\r\n"))
      << status;
  EXPECT_TRUE(has(status, "\r\nserial      4321 disturbances, 0 damaged records, 0 events dropped\r\n")) << status;
  EXPECT_EQ(lines(status), 11);
}

TEST_F(ConsoleLines, WatchIsALineTwiceASecond) {
  at_work();
  send("watch\r");
  run(300);
  EXPECT_TRUE(has(text, "running   600.5 rpm of -712.3 rpm   d 1.23 A, q -5.68 A   287.6 V\r\n")) << text;
  text.clear();
  run(4600);
  EXPECT_EQ(lines(text), 0);
  run(200);
  EXPECT_EQ(lines(text), 1);
  run(5000);
  EXPECT_EQ(lines(text), 2);
}

// The newest first, each with its circumstances.
TEST_F(ConsoleLines, FaultsWithTheirCircumstances) {
  at_work();
  inside::time_ms() = 5067;
  drive_trip(&drive, FAULT_LINK_LOW);
  at_work();
  inside::be_in(DRIVE_STOP);
  inside::time_ms() = 65407;
  drive_trip(&drive, FAULT_OVERRUN);
  run(10);  // nobody types yet: it is not told
  const std::string circumstances = " at 600.5 rpm, link 287.6 V, d 1.23 A, q -5.68 A\r\n";
  const std::string overrun = bench::words_of(CATALOGUE_FAULT, FAULT_OVERRUN);
  EXPECT_EQ(command("faults"), "2 since power-on, which was 65 s ago; the newest first\r\n65.407 s  " + overrun +
                                   ", stopping" + circumstances + "5.067 s  DC link below link_minimum, running" +
                                   circumstances);
}

// A star before what is not the default; a part that was asked for is forgotten with the next list.
TEST_F(ConsoleLines, AParametersRow) {
  const std::string meaning = "time after the start that the shaft is held stiffly, for a brake to open";
  EXPECT_EQ(command("list hold_time").rfind(to(to("hold_time", 23) + "0 ms", 42) + meaning, 0), 0u);
  parameters.hold_time = 100;
  EXPECT_EQ(command("list HOLD_TIME").rfind(to(to("hold_time", 22) + "*100 ms", 42) + meaning, 0), 0u);
  EXPECT_EQ(lines(command("list hold_time")), 1);
  EXPECT_EQ(lines(command("list", 30000)), parameter_count());
}

TEST_F(ConsoleLines, ASignalsRow) {
  at_work();
  const std::string row = to(to("speed", 22) + "600.50 rpm", 40) + "mechanical speed in use\r\n";
  EXPECT_EQ(command("signals mechanical"), row);
  EXPECT_EQ(command("get speed"), row);
}

TEST_F(ConsoleLines, APartIsForgottenWithTheNextList) {
  int here = 0;
  for (std::uint16_t k = 0; k < signal_count(); ++k) here += !signal_is_left_out(k);
  EXPECT_EQ(lines(command("signals start_phase")), 1);
  EXPECT_EQ(lines(command("signals", 10000)), here);
}

TEST_F(ConsoleLines, AValueHasTheDecimalsThatItsFormatIsWorth) {
  const std::pair<int, int> cases[] = {{0, 0}, {1, 1}, {8, 1}, {9, 2}, {16, 2}, {17, 3}, {20, 3}, {21, 4}, {32, 4}};
  for (const auto& [q, decimals] : cases) {
    signal_info_t s = *signal_info(0);
    s.q = static_cast<std::uint16_t>(q);
    EXPECT_EQ(signal_decimals(&s), decimals) << q;
  }
}

TEST_F(ConsoleLines, ASpeedBeyondTheLimitIsRefusedWithBoth) {
  EXPECT_EQ(command("ref -9000.5"), "-9000.5 rpm is beyond speed_limit, 3300 rpm: nothing changed\r\n");
  EXPECT_EQ(command("ref 3300"), "ref 3300.00 rpm\r\n") << "which may be reached";
}

TEST_F(ConsoleLines, ACommissioningSaysHowFarItIs) {
  NEEDS("commissioning");
  commissioning.outcome = COMMISSIONING_RUNNING;
  commissioning.phase = COMMISSIONING_STAIRCASE;
  commissioning.staircase.index = 7;
  EXPECT_EQ(command("commission"), "commissioning: under way, 9 %: DC staircase: resistance, drop, dead time\r\n");
}

// No resistance at all was measured, of which a device has 35 mohm: the winding would have less than none.
TEST_F(ConsoleLines, AResultIsWhatWasAndWhatIs) {
  NEEDS("commissioning");
  commissioning.evaluate = true;  // and nothing was measured
  commissioning_service(&drive);
  std::string rows = command("commission results", 20000);
  rows.erase(0, rows.find('\n') + 1);  // how far it is, as `commission` says it
  EXPECT_EQ(rows.rfind(to(to("stator_resistance", 22) + "0.3200 -> -0.0350 ohm", 50) +
                           bench::words_of(CATALOGUE_VERDICT, VERDICT_NOT_MEASURED) + "\r\n",
                       0),
            0u)
      << rows;
}

// Of the scope as it is set up when nothing else was said: a quarter of the records before the trigger, which is now.
TEST_F(ConsoleLines, AScopeThatWasOnlyGivenItsChannels) {
  NEEDS("scope");
  EXPECT_EQ(command("scope"), "scope: idle, 0 records\r\n");
  (void)command("scope channels speed");
  EXPECT_EQ(command("scope"),
            "scope: idle, 0 records\r\nchannels speed\r\ntrigger now, every 1, before 128, mode single\r\n");
}

TEST_F(ConsoleLines, ARecordOfTheScopeIsARow) {
  NEEDS("scope");
  at_work();
  inside::current_dq_q20().q = raw(-5.5, 20);
  (void)command("scope channels speed current_q state");
  (void)command("scope arm");
  inside::time_ms() = 7;
  for (int k = 0; k < 600; ++k)
    if (drive_onlooker != nullptr) drive_onlooker();
  const std::string state = command("scope");
  EXPECT_EQ(state.rfind("scope: done, 512 records, trigger in record 128 at 7 ms\r\n", 0), 0u) << state;
  const auto row = [](const std::string& number) {
    return to(to(to(to(number, 6) + "600.50", 18) + "-5.500", 30) + "4", 42) + "\r\n";
  };
  EXPECT_EQ(command("scope print 500"), row("0") + row("500"));
}

// A key ends a watch and the wait for a start, but not the wait for the store: its answer comes first.
TEST_F(ConsoleLines, WhatIsTypedDuringASaveWaits) {
  NEEDS("store");
  send("save\rversion\r");
  run(20000);
  EXPECT_TRUE(has(text, "the values have been saved")) << text;
  ASSERT_TRUE(has(text, "protocol 1")) << text;
  EXPECT_LT(text.find("the values have been saved"), text.find("protocol 1"));
}

// Each way in which the port has seen a disturbance.
TEST_F(ConsoleLines, AnyErrorOfThePortDisturbsALine) {
  for (std::uint16_t hal_sci_errors_t::* error :
       {&hal_sci_errors_t::framing, &hal_sci_errors_t::overrun, &hal_sci_errors_t::breaks, &hal_sci_errors_t::lost}) {
    text.clear();
    send("ref 5");
    run(50);
    ++(board.serial_errors.*error);
    send("0\r");
    run(300);
    EXPECT_TRUE(has(text, "the line was disturbed on its way: nothing done, send it again\r\n> ")) << text;
    EXPECT_EQ(drive_commanded_speed(), 0);
    EXPECT_EQ(command("ref 0"), "ref 0.00 rpm\r\n") << "the next one is not";
  }
}

// Sixty-three characters wait for the end of an answer; with one more the answer ends.
TEST_F(ConsoleLines, WhatIsTypedAheadHasItsRoom) {
  send("list\r");
  run(100);
  send(std::string(63, ' '));
  run(50);
  EXPECT_FALSE(has(text, "more input")) << text;
  send(" ");
  run(50);
  EXPECT_TRUE(has(text, "more input than can be kept: the answer ends here\r\n> ")) << text;
}

TEST_F(ConsoleLines, FourNamesAreSuggestedAtMost) {
  NEEDS("console/suggest");
  const std::string said = command("get curren");
  EXPECT_EQ(std::count(said.begin(), said.end(), ','), 3) << said;
  EXPECT_EQ(said.rfind("there is no parameter 'curren': did you mean ", 0), 0u) << said;
}

// Whoever comes second is told what the first one is at.
TEST_F(ConsoleLines, AStoreThatIsBusySaysAtWhat) {
  NEEDS("store");
  const std::pair<answer_status_t (*)(octet_writer_t*), const char*> actions[] = {
      {action_save, "save"}, {action_load, "load"}, {action_defaults, "defaults"}};
  std::uint16_t octets[100];
  octet_writer_t why = octet_writer(octets, 100);
  ASSERT_EQ(action_save(&why), ANSWER_OK);
  EXPECT_EQ(why.count, 0);
  for (const auto& [action, name] : actions) {
    why = octet_writer(octets, 100);
    EXPECT_EQ(action(&why), ANSWER_BUSY) << name;
    EXPECT_EQ(std::string(octets, octets + why.count),
              "the store is busy: " + bench::words_of(CATALOGUE_STORE, static_cast<std::uint16_t>(store_state())));
  }
}

}  // namespace

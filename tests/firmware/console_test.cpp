// What a person sees in a terminal.

#include "tests/firmware/console.hpp"

#include <cstring>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/slot_of.hpp"

extern "C" {
#include "firmware/console/commands.h"
#include "firmware/console/output.h"
#include "firmware/console/suggest/suggest.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

TEST_F(Console, EveryCommandIsExplained) {
  NEEDS("commissioning", "store", "scope", "can");
  const std::string help = command("help");
  int rows = 0;
  for (std::uint16_t k = 0; command_name(k) != PACKED_NONE; ++k, ++rows) {
    EXPECT_TRUE(has(help, std::string("\n") + bench::text_of(command_name(k)) + " ") ||
                help.rfind(bench::text_of(command_name(k)), 0) == 0)
        << bench::text_of(command_name(k));
    EXPECT_TRUE(has(command(std::string("help ") + bench::text_of(command_name(k))),
                    bench::text_of(static_cast<packed_text_t>(TEXT_COMMAND_help + k))));
  }
  EXPECT_GE(rows, 16);
  EXPECT_TRUE(has(command("help scope"), "scope trigger"));
  EXPECT_FALSE(has(command("help set"), "scope"));
}

TEST_F(Console, GetAndSet) {
  EXPECT_EQ(command("set speed_ramp 250 rpm/s"), "speed_ramp = 250 rpm/s\r\n");
  EXPECT_EQ(parameters.speed_ramp, 250 * 256);
  EXPECT_EQ(command("SET Speed_Ramp 300rpm/s"), "speed_ramp = 300 rpm/s\r\n");
  EXPECT_EQ(command("set stator_resistance .41"), "stator_resistance = 0.4100 ohm\r\n");
  EXPECT_EQ(command("set ldq_1 -0.5 mH"), "ldq_1 = -0.5000 mH\r\n");
  EXPECT_EQ(command("get speed_limit"),
            "speed_limit = 3300 rpm\r\n  10 .. 20000 rpm, default 3300, number 9; only while the power stage is off\r\n"
            "  largest speed reference\r\n");
  EXPECT_TRUE(has(command("get link_voltage"), "DC-link voltage")) << "signals too";
}

TEST_F(Console, WhatIsRefusedIsExplained) {
  EXPECT_EQ(command("set speed_limit 70000 rpm"),
            "speed_limit = 70000 is outside of 10 .. 20000 rpm: nothing changed\r\n");
  EXPECT_EQ(command("set speed_limit 7 krpm"),
            "speed_limit = 7 krpm is not a number (point, no comma or space) in 10 .. 20000 rpm: nothing changed\r\n");
  EXPECT_EQ(command("set speed_limit 7krpm"),
            "speed_limit = 7krpm is not a number (point, no comma or space) in 10 .. 20000 rpm: nothing changed\r\n");
  EXPECT_EQ(command("set pole_pairs 3 A"),
            "pole_pairs = 3 A is not a number (point, no comma or space) in 1 .. 30: nothing changed\r\n");
  EXPECT_EQ(command("set speed_limit fast"),
            "speed_limit = fast is not a number (point, no comma or space) in 10 .. 20000 rpm: nothing changed\r\n");
  EXPECT_TRUE(has(command("set speed_limit"), "set name value [unit]"));
  EXPECT_TRUE(has(command("set speed_limit 1 000 rpm"), "speed_limit = 1 000 rpm is not a number"));
  EXPECT_EQ(parameters.speed_limit, 3300 * 256);
  inside::be_in(DRIVE_RUN);
  EXPECT_EQ(command("set speed_limit 1000"),
            "speed_limit may not change while the power stage is on: stop the drive first\r\n");
}

TEST_F(Console, DidYouMean) {
  NEEDS("console/suggest");
  EXPECT_EQ(command("strat"), "there is no command 'strat': did you mean start?\r\n");
  EXPECT_EQ(command("get speed_lmit"), "there is no parameter 'speed_lmit': did you mean speed_limit?\r\n");
  EXPECT_EQ(command("get ldq"), "there is no parameter 'ldq': did you mean ldq_1, ldq_2, ldq_3, ldq_4?\r\n");
  EXPECT_EQ(command("watch sped"), "there is no signal 'sped': did you mean speed?\r\n");
}

TEST_F(Console, ANameThatThereIsNot) {
  EXPECT_EQ(command("xyzzy"), "there is no command 'xyzzy': see 'help'\r\n");
  EXPECT_EQ(command("?"), "there is no command '?': see 'help'\r\n");
  EXPECT_EQ(command("help me"), "there is no command 'me': see 'help'\r\n");
  EXPECT_EQ(command("get xyzzy"), "there is no parameter 'xyzzy': see 'list'\r\n");
  EXPECT_EQ(command("watch xyzzy"), "there is no signal 'xyzzy': see 'signals'\r\n");
}

// A name that another edition has is no mistake to be put right.
TEST_F(Console, WhatTheEditionHasNotIsNamedWithIt) {
  const struct {
    const char *name, *feature;
  } names[] = {{"flux_low", "sources/flux"},     {"load_angle", "sources/flux"},      {"can_node", "can"},
               {"wiring", "start/flying"},       {"if_speed", "start/if_start"},      {"speed_limit", "drive"},
               {"paper_terms", "sources/paper"}, {"encoder_trim", "sources/encoder"}, {"speed", "drive"}};
  for (const auto& n : names) {
    const std::string left_out = std::string("'") + n.name + "' is not in this edition of the firmware, " +
                                 edition_name + ": see 'Editions' in the book\r\n";
    EXPECT_EQ(command(std::string("get ") + n.name) == left_out, !missing_of({n.feature}).empty()) << n.name << text;
  }
}

TEST(Suggest, OneEditOrAPart) {
  NEEDS("console/suggest");
  const auto near = [](packed_text_t name, const std::string& text) {
    const Octets o(text.begin(), text.end());
    const word_t word = {o.data(), static_cast<std::uint16_t>(o.size())};
    return suggest_is_near(name, &word);
  };
  for (const char* s : {"stop", "sto", "stopp", "stpo", "stap", "tsop", "xstop", "top", "STOP"}) {
    EXPECT_TRUE(near(TEXT_COMMAND_NAME_stop, s)) << s;
  }
  for (const char* s : {"", "s", "start", "spot", "xyz", "stpp0", "sotp0"}) {
    EXPECT_FALSE(near(TEXT_COMMAND_NAME_stop, s)) << s;
  }
  for (const char* s : {"limit", "SpeedLimit", "speed-limit", "speed_imit", "spede_limit", "speed_limit"}) {
    EXPECT_TRUE(near(TEXT_PARAMETER_NAME_speed_limit, s)) << s;
  }
  EXPECT_TRUE(near(TEXT_SIGNAL_NAME_speed, "speed_limit"));
  EXPECT_FALSE(near(TEXT_UNIT_V, "vyz") || near(TEXT_UNIT_V, "v")) << "one letter says nothing";
}

TEST_F(Console, List) {
  parameters.wiring_check = 1;  // as by default: nothing is marked as changed
  const std::string all = command("list", 30000);
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    EXPECT_TRUE(has(all, bench::text_of(parameter_name(parameter_info(k)))));
    EXPECT_TRUE(has(all, bench::text_of(parameter_meaning(parameter_info(k))))) << "whole";
  }
  EXPECT_FALSE(has(all, "..."));
  EXPECT_FALSE(has(all, "*"));
  const std::string some = command("list brake");
  EXPECT_TRUE(has(some, "hold_time")) << "meanings are looked through, too";
  EXPECT_FALSE(has(some, "speed_limit"));
  parameters.hold_time = 100;
  EXPECT_TRUE(has(command("list brake"), "*100 ms"));
}

TEST_F(Console, StartRefStop) {
  EXPECT_TRUE(has(command("start free"), "not ready yet"));
  inside::be_in(DRIVE_READY);
  EXPECT_EQ(command("ref 600 rpm"), "ref 600.00 rpm\r\n");
  EXPECT_EQ(command("ref -50rpm"), "ref -50.00 rpm\r\n");
  EXPECT_EQ(command("ref"), "ref -50.00 rpm\r\n");
  EXPECT_TRUE(has(command("ref 9000"), "beyond speed_limit, 3300 rpm"));
  EXPECT_TRUE(has(command("ref 60 Hz"), "nothing changed"));
  EXPECT_TRUE(has(command("ref 60 rpm now"), "nothing changed"));
  EXPECT_TRUE(has(command("start now"), "nothing done"));
  EXPECT_FALSE(inside::start_requested());
  send("start free\r");
  run(300);
  EXPECT_TRUE(inside::start_requested());
  text.clear();
  inside::be_in(DRIVE_RUN);
  run(100);
  EXPECT_TRUE(has(text, "running after 3")) << text;
  EXPECT_EQ(command("stop at once please"), "stopping\r\n");
  EXPECT_TRUE(inside::stop_requested());
  inside::be_in(DRIVE_READY);
  EXPECT_EQ(command("stop"), "the power stage is off\r\n");
  EXPECT_EQ(command("coast"), "power stage off\r\n");
}

TEST_F(Console, StartAndResetStandAlone) {
  inside::be_in(DRIVE_FAULT);
  EXPECT_EQ(command("reset now"), "this command takes nothing after it: nothing done\r\n");
  EXPECT_FALSE(inside::reset_requested());
  EXPECT_TRUE(has(command("reset"), "cleared"));
  EXPECT_TRUE(inside::reset_requested());
}

// A line has room for more words than a command takes.
TEST_F(Console, WordsBeyondTheLastAreLeftOut) {
  std::string words;
  for (int k = 0; k < 30; ++k) words += " x";
  EXPECT_EQ(command("stop" + words), "the power stage is off\r\n");
  EXPECT_TRUE(has(command("set speed_limit 1" + words), "speed_limit = 1 x x x x x x x x x x x x x x is not a number"));
  EXPECT_TRUE(has(command("watch" + words), "watch shows at most four signals"));
}

TEST_F(Console, AStartThatTakesLongIsLeftToItself) {
  inside::be_in(DRIVE_READY);
  send("start free\r");
  run(100);
  inside::time_ms() += 4900;
  run(500);
  EXPECT_FALSE(has(text, "not running yet"));
  run(1000);
  EXPECT_TRUE(has(text, "not running yet: see 'status'\r\n> ")) << text;
  EXPECT_TRUE(inside::start_requested()) << "it may still come";
}

TEST_F(Console, WaitingForTheStartEndsWithAnyKey) {
  inside::be_in(DRIVE_READY);
  send("start free\rstop\r");
  run(500);
  EXPECT_TRUE(inside::stop_requested());
  EXPECT_FALSE(inside::start_requested());
}

TEST_F(Console, AFaultIsToldUnaskedToWhoTypes) {
  inside::be_in(DRIVE_RUN);
  drive_trip(&drive, FAULT_STOP);
  run(100);
  EXPECT_EQ(text, "") << "nobody is there";
  send("sta");
  run(100);
  text.clear();
  inside::be_in(DRIVE_RUN);
  drive_trip(&drive, FAULT_LINK_LOW);
  run(300);
  EXPECT_TRUE(has(text, "! fault: DC link below link_minimum\r\n")) << text;
  EXPECT_TRUE(has(text, "\r> sta")) << "what has been typed is still there";
  (void)ask(REQUEST_STATUS);
  text.clear();
  inside::be_in(DRIVE_RUN);
  drive_trip(&drive, FAULT_LINK_HIGH);
  run(300);
  EXPECT_TRUE(has(text, "! fault: DC link above")) << "a terminal that keeps the watchdog alive is still one: " << text;
  (void)ask(REQUEST_IDENTITY);
  text.clear();
  inside::be_in(DRIVE_RUN);
  drive_trip(&drive, FAULT_LINK_LOW);
  run(300);
  EXPECT_EQ(text, "") << "a machine is there";
}

TEST_F(Console, AFaultThatIsForgottenIsNotTold) {
  send("x");
  inside::be_in(DRIVE_RUN);
  drive_trip(&drive, FAULT_LINK_LOW);
  run(300);
  ASSERT_TRUE(has(text, "! fault"));
  text.clear();
  drive_reset();
  run(300);
  EXPECT_EQ(text, "");
}

TEST_F(Console, SaveLoadDefaults) {
  NEEDS("store");
  EXPECT_TRUE(has(command("status"), "nothing has been saved yet"));
  (void)command("set speed_ramp 250");
  EXPECT_TRUE(has(command("save", 20000), "the values have been saved"));
  EXPECT_TRUE(has(command("status"), "saves so far 1"));
  EXPECT_TRUE(has(command("defaults"), "at its default"));
  EXPECT_EQ(parameters.speed_ramp, 3000 * 256);
  EXPECT_TRUE(has(command("load", 20000), "the saved values are in force"));
  EXPECT_EQ(parameters.speed_ramp, 250 * 256);
  inside::be_in(DRIVE_RUN);
  EXPECT_TRUE(has(command("load"), "stop the drive first"));
  EXPECT_TRUE(has(command("defaults"), "stop the drive first"));
  EXPECT_TRUE(has(command("save", 20000), "the values have been saved")) << "while it runs, too";
}

// What a firmware with wider ranges has saved.
TEST_F(Console, LoadSaysWhichValuesWereRefused) {
  NEEDS("store");
  const auto load = [&](const std::vector<slot_entry_t>& entries) {
    const Octets slot = slot_of(SLOT_VERSION, 1, entries);
    std::copy(slot.begin(), slot.end(), nvm.memory.begin());
    return command("load", 20000);
  };
  const std::string migrated = "values saved by another firmware are in force; save to keep them in this one's format";
  const slot_entry_t ramp = {86, 8, -1}, limit = {8, 20, INT32_MAX};
  EXPECT_EQ(load({}), migrated + "\r\n");
  EXPECT_EQ(load({limit}), migrated + "; 1 refused, now at their default: current_limit\r\n");
  EXPECT_EQ(load({ramp, limit}), migrated + "; 2 refused, now at their default: speed_ramp ..\r\n");
}

TEST_F(Console, AMemoryThatDoesNotAnswerIsTold) {
  NEEDS("store");
  nvm.absent = true;
  const std::string said = command("save", 40000);
  EXPECT_TRUE(has(said, "fail") || has(said, "does not answer")) << said;
}

TEST_F(Console, Version) { EXPECT_EQ(command("version"), kVersion); }

TEST_F(Console, CtrlCEndsALongAnswerAndTheLine) {
  send("list\r");
  run(400);
  send("\x03");
  run(400);
  text.clear();
  run(2000);
  EXPECT_EQ(text, "");
  EXPECT_EQ(command("version"), kVersion);
  send("set speed_ramp 1\x03");
  run(200);
  EXPECT_EQ(command("version"), kVersion);
}

TEST_F(Console, WhatIsTypedAheadIsNotLost) {
  send("list\rversion\rref 70\r");
  run(30000);
  EXPECT_TRUE(has(text, "protocol 1"));
  EXPECT_EQ(drive_commanded_speed(), 70 * 65536);
}

TEST_F(Console, ToStopDoesNotWaitForTheEndOfALongAnswer) {
  inside::be_in(DRIVE_RUN);
  send("list\rref 70\r");
  run(200);
  send("stop\r\n");
  run(100);
  EXPECT_TRUE(inside::stop_requested());
  run(30000);
  EXPECT_TRUE(has(text, "the answer and what was typed ahead end here\r\nstopping\r\n> "));
  EXPECT_EQ(drive_commanded_speed(), 0) << "and that was said";
}

// A terminal that ends its lines with a line feed stops the motor as soon as any.
TEST_F(Console, EitherEndOfALineStopsInTheMiddleOfAnAnswer) {
  for (const char* end : {"\r", "\n"}) {
    inside::be_in(DRIVE_RUN);
    inside::withdraw_stop();
    send("list\r");
    run(200);
    send(std::string("stop") + end);
    run(100);
    EXPECT_TRUE(inside::stop_requested()) << int(end[0]);
    run(2000);
  }
}

TEST_F(Console, MoreThanCanBeKeptEndsTheAnswerAndIsNotLostEither) {
  std::string lines = "list\r";
  for (int k = 0; k < 40; ++k) lines += "version\r";
  lines += "ref 70\r";
  send(lines);
  run(60000);
  EXPECT_TRUE(has(text, "more input than can be kept"));
  EXPECT_EQ(drive_commanded_speed(), 70 * 65536);
}

TEST_F(Console, RecordsAreAnsweredInTheMiddleOfALongAnswer) {
  send("list\r");
  run(200);
  const Answer a = ask(REQUEST_STATUS);
  EXPECT_TRUE(a.came());
  run(20000);
  for (std::uint16_t k = 0; k < parameter_count(); ++k)
    EXPECT_TRUE(has(text, bench::text_of(parameter_meaning(parameter_info(k)))));
}

TEST_F(Console, ADisturbedLineIsNotObeyed) {
  inside::be_in(DRIVE_RUN);
  send("set speed_ramp 1");
  run(50);
  board.serial_errors.framing++;
  send("000\r");
  run(500);
  EXPECT_TRUE(has(text, "the line was disturbed on its way"));
  EXPECT_EQ(parameters.speed_ramp, 3000 * 256);
  send(
      "ref \xC3\xA4"
      "50\r");
  run(300);
  EXPECT_EQ(drive_commanded_speed(), 0);
  send("st\xFFop\r");
  run(300);
  EXPECT_TRUE(inside::stop_requested()) << "but to stop is always right";
  send(
      "co\xFF"
      "ast\r");
  run(300);
  EXPECT_TRUE(inside::coast_requested()) << "and to switch off";
  EXPECT_EQ(command("ref 50"), "ref 50.00 rpm\r\n") << "the next line is another one";
}

TEST_F(Console, ALineThatIsTooLongIsRefused) {
  EXPECT_TRUE(has(command("ref 50" + std::string(80, ' ')), "at most 80 characters: nothing done"));
  EXPECT_EQ(drive_commanded_speed(), 0);
}

// Lines never come out in pieces: whatever the room, whole lines or none.
TEST_F(Console, NothingIsWrittenWithoutRoomForAllOfIt) {
  board.serial_room = 100;
  send("version\r");
  for (int k = 0; k < 300; ++k) {
    link_service();
    console_service();
  }
  EXPECT_TRUE(board.serial_out.empty());
  EXPECT_FALSE(board.serial_in.empty());
  EXPECT_EQ(board.serial_room, 100);
}

}  // namespace

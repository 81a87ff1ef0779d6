// The captured scope, set up and printed in a terminal.

#include <sstream>

#include "tests/firmware/console.hpp"

extern "C" {
#include "firmware/mode/states.h"
#include "firmware/scope/scope.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

class ConsoleScope : public Console {
 protected:
  void SetUp() override {
    NEEDS("scope");
    Console::SetUp();
  }
  void steps(int n) {
    for (int k = 0; k < n; ++k)
      if (drive_onlooker != nullptr) drive_onlooker();
  }
  static std::string first_words(const std::string& rows) {
    std::istringstream lines(rows);
    std::string line, words;
    while (std::getline(lines, line)) words += line.substr(0, line.find(' ') + 1);
    return words;
  }
  /// Of the only channel, as it is set up.
  std::uint16_t shift_of(const std::string& signal) {
    EXPECT_TRUE(has(command("scope channels " + signal), "set"));
    return scope_setup_in_force()->channel[0].shift;
  }
};

TEST_F(ConsoleScope, TheScopeFromWordsToNumbers) {
  EXPECT_TRUE(has(command("scope arm"), "first: scope channels"));
  EXPECT_TRUE(has(command("scope trigger now"), "first: scope channels"));
  EXPECT_TRUE(has(command("scope channels speed current_q angle"), "set"));
  EXPECT_TRUE(has(command("scope trigger speed rising 100 rpm"), "set"));
  EXPECT_TRUE(has(command("scope trigger speed rising 100 A"), "100 A is not a number"));
  EXPECT_TRUE(has(command("scope trigger speed up 100"), "rising|falling"));
  EXPECT_TRUE(has(command("scope every 2"), "set"));
  EXPECT_TRUE(has(command("scope every 0"), "nothing changed"));
  EXPECT_TRUE(has(command("scope before 10"), "set"));
  EXPECT_TRUE(has(command("scope before 2000"), "nothing changed"));
  EXPECT_TRUE(has(command("scope mode single"), "set"));
  EXPECT_TRUE(has(command("scope"),
                  "channels speed current_q angle\r\n"
                  "trigger speed rising 100.00 rpm, every 2, before 10, mode single"));
  EXPECT_TRUE(has(command("scope arm"), "armed"));
  inside::be_in(DRIVE_RUN);
  for (int k = 0; k < 3000; ++k) {
    inside::selected().speed_bpp = bpp_of(k);
    inside::current_dq_q20().q = -5 * (1 << 20);
    inside::selected().angle_bam = 1u << 30;
    inside::time_ms() = static_cast<std::uint32_t>(k);
    if (drive_onlooker != nullptr) drive_onlooker();
  }
  EXPECT_TRUE(has(command("scope"), "scope: done, 512 records, trigger in record 10"));
  const std::string rows = command("scope print 5", 60000);
  EXPECT_TRUE(has(rows, "\n10    10")) << rows.substr(0, 300);
  EXPECT_TRUE(has(rows, "-5.000      0.2500"));
  EXPECT_TRUE(has(command("scope arm"), "armed"));
  inside::be_in(DRIVE_READY);
  for (int k = 0; k < 20; ++k)
    if (drive_onlooker != nullptr) drive_onlooker();
  EXPECT_TRUE(has(command("scope stop"), "stopped"));
  const std::string unknown = command("scope print 1", 6000);
  EXPECT_TRUE(has(unknown, "0     -           -           -")) << unknown;
  EXPECT_TRUE(has(command("scope stop"), "stopped"));
}

// A record is a word: what a unit reaches decides which bits of a signal it keeps.
TEST_F(ConsoleScope, ARecordReachesWhatTheQuantityReaches) {
  EXPECT_EQ(shift_of("current_q"), 20 - 10) << "32 A";
  EXPECT_EQ(shift_of("link_voltage"), 16 - 6) << "512 V";
  EXPECT_EQ(shift_of("speed"), 16 - 2) << "8192 rpm";
  EXPECT_EQ(shift_of("angle"), 32 - 15) << "a turn";
  EXPECT_EQ(shift_of("weight"), 15 - 8) << "a number without a unit: 128";
  EXPECT_EQ(shift_of("state"), 0) << "as it is";
  EXPECT_EQ(shift_of("deviation_q"), 8 + 3) << "262144 A/s: eight of them are one step of the record";
}

TEST_F(ConsoleScope, AStepOfARecordMayBeMoreThanOne) {
  EXPECT_TRUE(has(command("scope channels deviation_q"), "set"));
  EXPECT_TRUE(has(command("scope trigger now"), "set"));
  EXPECT_TRUE(has(command("scope arm"), "armed"));
  inside::be_in(DRIVE_RUN);
  inside::deviation_q20() = -(9 << 20);  // in a period of 100 us
  steps(2000);
  EXPECT_TRUE(has(command("scope print 500", 2000), "\n500   -90000.0"));
}

TEST_F(ConsoleScope, OneToFourChannels) {
  EXPECT_TRUE(has(command("scope channels"), "takes one to four signals"));
  EXPECT_TRUE(has(command("scope channels state fault limit speed angle"), "takes one to four signals"));
  EXPECT_EQ(scope_setup_in_force()->count, 0);
  EXPECT_TRUE(has(command("scope channels state fault limit speed"), "set"));
  EXPECT_EQ(scope_setup_in_force()->count, 4);
}

TEST_F(ConsoleScope, ATriggerIsASignalAnEdgeAndALevel) {
  (void)command("scope channels speed");
  const std::string wants = "scope trigger <signal> rising|falling";
  EXPECT_TRUE(has(command("scope trigger speed"), wants));
  EXPECT_TRUE(has(command("scope trigger speed rising"), wants));
  EXPECT_TRUE(has(command("scope trigger speed now 100"), wants)) << "now has no level";
  EXPECT_TRUE(has(command("scope trigger sped rising 100"), "there is no signal 'sped': "));
  const std::string no_number =
      " is not a number (point, no comma or space) in -8191.75 .. 8191.75 rpm: nothing changed";
  for (const std::string typed : {"100x", "100 rpm now", "100 V", "1,5", "1 000", "1 000 rpm", "100 rpm 5"}) {
    EXPECT_EQ(command("scope trigger speed rising " + typed), typed + no_number + "\r\n");
  }
  const std::string outside = " is outside of -8191.75 .. 8191.75 rpm: nothing changed";
  EXPECT_TRUE(has(command("scope trigger speed rising 40000"), "40000" + outside));
  EXPECT_TRUE(has(command("scope trigger speed rising 8192"), "8192" + outside));
  EXPECT_TRUE(has(command("scope trigger speed falling -8192 rpm"), "-8192" + outside));
  EXPECT_TRUE(has(command("scope trigger angle above -0.5 turn"), "-0.5 is outside of -0.5000 .. 0.5000 turn"));
  EXPECT_TRUE(has(command("scope trigger state above 3e9"), "3e9 is outside of -32767 .. 32767: nothing"));
  EXPECT_TRUE(has(command("scope trigger state rising 2.5"), "2.5 is not a whole number in -32767 .. 32767: nothing"));
  EXPECT_EQ(scope_setup_in_force()->edge, SCOPE_AT_ONCE) << "nothing of that was taken";
  EXPECT_TRUE(has(command("scope trigger speed above 100"), "set")) << "the unit may be left out";
  EXPECT_EQ(scope_setup_in_force()->edge, SCOPE_ABOVE);
  EXPECT_EQ(scope_setup_in_force()->level, 100 << 16);
  EXPECT_TRUE(has(command("scope trigger now"), "set"));
  EXPECT_TRUE(has(command("scope"), "\r\ntrigger now, every 1,"));
}

TEST_F(ConsoleScope, AnEdgeHasAHysteresis) {
  (void)command("scope channels speed");
  const std::string wants = "scope hysteresis <width>, for a trigger rising|falling|either";
  EXPECT_TRUE(has(command("scope hysteresis 5"), wants)) << "of what is recorded at once";
  EXPECT_TRUE(has(command("scope trigger speed rising 100"), "set"));
  EXPECT_EQ(scope_setup_in_force()->hysteresis, SCOPE_BY_SPAN);
  for (const char* typed : {"5", "5 rpm", "5.0rpm"}) {
    EXPECT_TRUE(has(command(std::string("scope hysteresis ") + typed), "set")) << typed;
    EXPECT_EQ(scope_setup_in_force()->hysteresis, 5 << 16) << typed;
    EXPECT_EQ(scope_setup_in_force()->level, 100 << 16) << typed;
  }
  EXPECT_TRUE(has(command("scope"), "\r\ntrigger speed rising 100.00 rpm, hysteresis 5.00, every 1,"));
  EXPECT_TRUE(has(command("scope hysteresis 5 5"), "5 5 is not a number"));
  EXPECT_TRUE(has(command("scope hysteresis -5"), "-5 is outside of 0.00 .. 8191.75 rpm: nothing changed"));
  EXPECT_TRUE(has(command("scope hysteresis"), wants));
  EXPECT_EQ(scope_setup_in_force()->hysteresis, 5 << 16) << "nothing of that was taken";
  EXPECT_TRUE(has(command("scope trigger speed above 100"), "set"));
  EXPECT_TRUE(has(command("scope hysteresis 5"), wants));
  EXPECT_EQ(scope_setup_in_force()->hysteresis, SCOPE_BY_SPAN) << "a trigger begins without";
}

TEST_F(ConsoleScope, NumbersAreWholeAndFitAWord) {
  (void)command("scope channels speed");
  EXPECT_TRUE(has(command("scope every 65535"), "set"));
  for (const char* number : {"", " 2 3", " 2x", " 2.5", " -1", " 65536", " 1,5", " 1e9", " 99999999999"}) {
    EXPECT_EQ(command(std::string("scope every") + number),
              std::string("every") + number + " is not a whole number in 1 .. 65535: nothing changed\r\n");
  }
  EXPECT_EQ(command("scope every 0"), "every 0 is not a whole number in 1 .. 65535: nothing changed\r\n");
  EXPECT_EQ(command("scope before 512"), "before 512 is not a whole number in 0 .. 511: nothing changed\r\n");
  EXPECT_TRUE(has(command("scope before 511"), "set"));
  EXPECT_EQ(scope_setup_in_force()->decimation, 65535);
  EXPECT_TRUE(has(command("scope every 1e1"), "set"));
  EXPECT_EQ(scope_setup_in_force()->decimation, 10);
}

TEST_F(ConsoleScope, OneCaptureOrOneAfterTheOther) {
  (void)command("scope channels speed");
  for (const char* mode : {"", " once", " auto auto"}) {
    EXPECT_TRUE(has(command(std::string("scope mode") + mode), "scope mode single, or scope mode auto")) << mode;
  }
  EXPECT_EQ(scope_setup_in_force()->mode, SCOPE_SINGLE);
  EXPECT_TRUE(has(command("scope mode auto"), "set"));
  EXPECT_TRUE(has(command("scope"), ", mode auto\r\n"));
  EXPECT_TRUE(has(command("scope mode single"), "set"));
  EXPECT_EQ(scope_setup_in_force()->mode, SCOPE_SINGLE);
}

TEST_F(ConsoleScope, WhatCanBePrinted) {
  (void)command("scope channels state");
  EXPECT_EQ(command("scope print"), "nothing has been recorded: 'scope arm' starts a capture\r\n");
  EXPECT_TRUE(has(command("scope arm"), "armed"));
  steps(20);
  EXPECT_TRUE(has(command("scope print"), "the scope is recording"));
  EXPECT_TRUE(has(command("scope stop"), "stopped"));
  EXPECT_EQ(first_words(command("scope print")), "0 16 ") << "what there is of one that was broken off";
  EXPECT_EQ(first_words(command("scope print 9")), "0 9 18 ");
  EXPECT_EQ(first_words(command("scope print 65535")), "0 ");
  EXPECT_EQ(command("scope print 0"), "print 0 is not a whole number in 1 .. 65535: nothing changed\r\n");
  EXPECT_TRUE(has(command("scope print few"), "print few is not a whole number"));
}

// A machine at the other end, or in AUTO mode the reading itself, may arm it meanwhile.
TEST_F(ConsoleScope, APrintEndsWhenTheScopeIsArmedAgain) {
  (void)command("scope channels state");
  inside::be_in(DRIVE_RUN);
  (void)command("scope arm");
  steps(2000);
  send("scope print 1\r");
  run(500);
  EXPECT_TRUE(has(text, "\n2     4 ")) << text;
  ASSERT_TRUE(scope_arm());
  steps(500);
  text.clear();
  run(20000);
  EXPECT_EQ(text, "> ") << "no rows of records that nobody made";
}

}  // namespace

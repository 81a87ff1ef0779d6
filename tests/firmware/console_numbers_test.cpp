// Numbers at the console: one rule for all of them.

#include "tests/firmware/console.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
}

namespace {

using namespace stillspin::test;

TEST_F(Console, NumbersAreOneRule) {
  EXPECT_EQ(command("set pole_pairs 2.5"), "pole_pairs = 2.5 is not a whole number in 1 .. 30: nothing changed\r\n");
  EXPECT_EQ(command("set pole_pairs 25e-1"),
            "pole_pairs = 25e-1 is not a whole number in 1 .. 30: nothing changed\r\n");
  EXPECT_EQ(command("set pole_pairs 2.0"), "pole_pairs = 2\r\n");
  EXPECT_EQ(command("set pole_pairs 0.3e1"), "pole_pairs = 3\r\n");
  EXPECT_EQ(command("set stator_resistance 1,5"),
            "stator_resistance = 1,5 is not a number (point, no comma or space) in 0.0010 .. 20.0000 ohm: nothing "
            "changed\r\n");
  EXPECT_EQ(command("set speed_ramp 1e3"), "speed_ramp = 1000 rpm/s\r\n");
  EXPECT_EQ(command("set speed_ramp 2e3rpm/s"), "speed_ramp = 2000 rpm/s\r\n");
  for (const char* far : {"1e9", "99999999999999", "-5", "4000000000"}) {
    EXPECT_EQ(command(std::string("set link_minimum ") + far),
              std::string("link_minimum = ") + far + " is outside of 10.0 .. 1000.0 V: nothing changed\r\n");
  }
  EXPECT_EQ(command("ref 1e3"), "ref 1000.00 rpm\r\n");
  EXPECT_EQ(command("ref 15e2rpm"), "ref 1500.00 rpm\r\n");
  EXPECT_EQ(command("ref 1,000"),
            "1,000 is not a number (point, no comma or space) in rpm up to speed_limit, 3300 rpm: nothing changed\r\n");
  EXPECT_EQ(
      command("ref 1  000 rpm"),
      "1  000 rpm is not a number (point, no comma or space) in rpm up to speed_limit, 3300 rpm: nothing changed\r\n");
  EXPECT_EQ(command("set speed_limit 1 000"),
            "speed_limit = 1 000 is not a number (point, no comma or space) in 10 .. 20000 rpm: nothing changed\r\n");
  EXPECT_EQ(
      command("set speed_limit fast rpm"),
      "speed_limit = fast rpm is not a number (point, no comma or space) in 10 .. 20000 rpm: nothing changed\r\n");
  EXPECT_EQ(command("ref 1e9"), "1e9 rpm is beyond speed_limit, 3300 rpm: nothing changed\r\n");
  EXPECT_EQ(command("ref -40000"), "-40000 rpm is beyond speed_limit, 3300 rpm: nothing changed\r\n");
  EXPECT_EQ(drive_commanded_speed(), 1500 * 65536);
}

}  // namespace

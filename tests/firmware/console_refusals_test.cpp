// Which lines count as not carried out: programs that type them learn it by a number, not from the text.

#include "tests/firmware/console.hpp"

extern "C" {
#include "firmware/api/status.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

class Refusals : public Console {
 protected:
  int of(const std::string& line) {
    const std::uint16_t before = feature_status.refusals;
    command(line);
    return feature_status.refusals - before;
  }
};

TEST_F(Refusals, ALineThatIsCarriedOutIsNone) {
  NEEDS("commissioning");
  for (const char* line : {"",
                           "help",
                           "help set",
                           "list speed",
                           "get speed_limit",
                           "get speed",
                           "set speed_ramp 250 rpm/s",
                           "ref",
                           "ref 100 rpm",
                           "status",
                           "faults",
                           "signals cur",
                           "commission",
                           "commission results",
                           "scope",
                           "scope channels speed",
                           "scope trigger speed rising 5",
                           "scope trigger now",
                           "scope every 2",
                           "scope before 9",
                           "scope mode auto",
                           "scope arm",
                           "scope stop",
                           "can",
                           "version",
                           "save",
                           "load",
                           "defaults",
                           "stop",
                           "coast"}) {
    EXPECT_EQ(of(line), 0) << line << ": " << text;
  }
}

TEST_F(Refusals, EveryWayToSayNoIsOne) {
  const std::string longer(90, 'a');
  for (const std::string& line : {std::string("strat"),
                                  std::string("help strat"),
                                  longer,
                                  std::string("get"),
                                  std::string("get nothing"),
                                  std::string("set"),
                                  std::string("set nothing 1"),
                                  std::string("set speed_limit fast"),
                                  std::string("set speed_limit 70000"),
                                  std::string("set speed_limit 7 A"),
                                  std::string("ref fast"),
                                  std::string("ref 20000"),
                                  std::string("start now"),
                                  std::string("reset now"),
                                  std::string("reset"),
                                  std::string("commission now"),
                                  std::string("watch a b c d e"),
                                  std::string("watch nothing"),
                                  std::string("scope nothing"),
                                  std::string("scope arm"),
                                  std::string("scope channels"),
                                  std::string("scope channels nothing"),
                                  std::string("scope every"),
                                  std::string("scope mode"),
                                  std::string("scope print 0"),
                                  std::string("scope print"),
                                  std::string("scope trigger speed above 40000"),
                                  std::string("scope trigger speed")}) {
    EXPECT_EQ(of(line), 1) << line << ": " << text;
  }
}

TEST_F(Refusals, WhatTheDriveDoesNotDoNowIsOne) {
  inside::be_in(DRIVE_RUN);
  for (const char* line : {"set speed_limit 1000", "load", "defaults", "start hold", "commission start"}) {
    EXPECT_EQ(of(line), 1) << line << ": " << text;
  }
}

// It is in force; what it does not fit to may follow.
TEST_F(Refusals, AValueThatOthersDoNotFitToYetIsTaken) {
  EXPECT_EQ(of("set link_minimum 450"), 0) << text;
  EXPECT_NE(text.find("link_minimum"), std::string::npos) << text;
}

TEST_F(Refusals, ASaveThatFailsIsOne) {
  nvm.absent = true;
  EXPECT_EQ(of("save"), 1) << text;
}

TEST_F(Refusals, AStartThatEndsInAFaultIsOne) {
  inside::be_in(DRIVE_READY);
  const std::uint16_t before = feature_status.refusals;
  send("start free\r");
  run(100);
  EXPECT_EQ(feature_status.refusals, before) << text;
  drive_trip(&drive, FAULT_LINK_LOW);
  run(100);
  EXPECT_EQ(feature_status.refusals, before + 1) << text;
}

}  // namespace

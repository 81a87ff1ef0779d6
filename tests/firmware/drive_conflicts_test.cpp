// Parameters that do not fit together: the drive names the conflict.

#include <cstring>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
#include "firmware/start/step.h"
}

namespace {

using namespace stillspin::test;
using stillspin::bench::text_of;

// The gates must be safe to open at the highest speed: sqrt(3) * 0.16 Vs * 4 * 2 pi / 60 = 0.1161 V per rpm.
TEST_F(Drive, SpeedLimitWhoseEmfExceedsTheLinkIsAConflict) {
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  parameters.speed_limit = raw(3617.0, 8);  // 419.9 V of 420
  use_parameters();
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  parameters.speed_limit = raw(3619.0, 8);  // 420.1 V
  use_parameters();
  ASSERT_NE(parameter_conflict(), PACKED_NONE);
  EXPECT_NE(text_of(parameter_conflict()).find("speed_limit"), std::string::npos);
}

TEST_F(Drive, LinkRegulationLiesBetweenTheFaults) {
  for (const double volts : {150.0, 419.5, 430.0}) {
    parameters.link_regulation = raw(volts, 16);
    use_parameters();
    ASSERT_NE(parameter_conflict(), PACKED_NONE) << volts;
    EXPECT_NE(text_of(parameter_conflict()).find("link_regulation"), std::string::npos);
  }
  parameters.link_regulation = raw(419.0, 16);
  use_parameters();
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
}

TEST_F(Drive, AHoldWantsTheAlternatingLayout) {
  parameters.hold_time = 100;
  use_parameters();
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  for (const int excitation : {0, 1, 4}) {
    parameters.excitation = excitation;
    use_parameters();
    ASSERT_NE(parameter_conflict(), PACKED_NONE) << excitation;
    EXPECT_NE(text_of(parameter_conflict()).find("hold_time"), std::string::npos);
  }
}

TEST_F(Drive, AMapWithoutSaliencyIsNamed) {
  parameters.lqq_4 = raw(60.0, 16);
  ASSERT_NE(parameter_conflict(), PACKED_NONE);
  EXPECT_NE(text_of(parameter_conflict()).find("lqq"), std::string::npos);
  parameters.lqq_4 = raw(65.0, 16);
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
}

}  // namespace

// A motor on far less voltage than it is made for: it starts the right way round, or the drive says what is missing.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

constexpr double kTurn = 6.283185307179586;

struct Count {
  int refused = 0, named = 0;
};

// Every result is a start within 60 degrees of the truth, or a fault that names voltage or polarity.
Count starts_at(double volts, bool real, const std::map<std::string, double>& told) {
  Count count;
  for (int k = 0; k < 12; ++k) {
    for (const double rpm : {5.0, -5.0}) {
      for (const std::uint64_t seed : {1u, 2u}) {
        RunRequest request = real ? noisy_request(0.002, seed) : encoder_request(0.002);
        request.setup.solver = 1;
        request.setup.nominal.link.source_voltage = volts;
        request.setup.nominal.initial.angle = 0.1 + k * kTurn / 12.0;
        request.parameters = told;
        request.parameters["position_source"] = 4.0;
        request.parameters["link_minimum"] = 10.0;
        request.commands = {{0.0, "speed_ref_rpm", rpm}};
        const RunResult result = run(request);
        if (result.completed) {
          EXPECT_LT(error_between(result, 0.0, 0.002), 60.0) << volts << " V, angle " << k << ", seed " << seed;
        } else {
          count.refused++;
          const bool named = result.reason.find("DC link is too low") != std::string::npos;
          count.named += named ? 1 : 0;
          EXPECT_TRUE(named || result.reason.find("polarity of the magnet") != std::string::npos) << result.reason;
        }
      }
    }
  }
  return count;
}

const std::map<std::string, double> kMap = {{"ldq_1", 0.029}, {"ldq_2", 0.056}, {"ldq_3", 0.084}, {"ldq_4", 0.112}};
const std::map<std::string, double> kLinear = {{"dead_time", 0.0},         {"turn_on_delay", 0.0},
                                               {"turn_off_delay", 0.0},    {"device_drop", 0.0},
                                               {"device_resistance", 0.0}, {"map_known", 1.0}};

TEST(LowLink, NoStartIsHalfATurnOff) {
  for (const double volts : {28.0, 32.0, 40.0}) {
    (void)starts_at(volts, false, kLinear);
    (void)starts_at(volts, true, {});
    (void)starts_at(volts, true, kMap);
  }
}

// A rotor without its load, ten times lighter than told, with nothing but motion to tell its polarity.
TEST(LowLink, AShaftTenTimesLighterThanToldStarts) {
  EXPECT_EQ(starts_at(300.0, true, {{"inertia", 0.0455}}).refused, 0);
}

// What has always started still does.
TEST(LowLink, FromAFifthOfTheVoltageOnEveryStartIsGood) {
  EXPECT_EQ(starts_at(64.0, false, kLinear).refused, 0);
  EXPECT_EQ(starts_at(64.0, true, {}).refused, 0);
  EXPECT_EQ(starts_at(300.0, true, kMap).refused, 0);
}

TEST(LowLink, TheVoltageIsNamed) {
  EXPECT_EQ(starts_at(28.0, true, {}).named, 48) << "no axis to be seen";
  EXPECT_GT(starts_at(32.0, true, {}).named, 12) << "no polarity";
}

}  // namespace
}  // namespace stillspin::bench

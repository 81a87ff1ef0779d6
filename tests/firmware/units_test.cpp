// Amperes and volts of the formats, and those of people.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/console.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/dictionary/units.h"
#include "firmware/drive/signals.h"
#include "firmware/text/text.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

class Scales : public Console {
 protected:
  void TearDown() override {
    parameters.current_scale = parameters.voltage_scale = 0;
    Console::TearDown();
  }
  static std::string quantity(std::int32_t raw, unit_t unit, std::uint16_t q, std::uint16_t decimals) {
    return bench::written(
        [=](octet_writer_t* w) { put_quantity(w, raw, static_cast<std::uint16_t>(unit), q, decimals); });
  }
};

TEST_F(Scales, EveryFormatHoldsAtEveryScale) {
  for (const int current : {-6, 0, 6}) {
    for (const int voltage : {-6, 0, 6}) {
      parameters.current_scale = current;
      parameters.voltage_scale = voltage;
      for (std::uint16_t k = 0; k < parameter_count(); k++) {
        const parameter_info_t* const p = parameter_info(k);
        EXPECT_LE(parameter_q(p), 40) << k;  // of what decimal_raw takes; below 0 it would be 65 000
        EXPECT_LE(parameter_decimals(p), UNIT_DECIMALS_MAX);
        EXPECT_GE(parameter_decimals(p), p->decimals);
      }
      for (std::uint16_t k = 0; signal_info(k) != nullptr; k++) EXPECT_LE(signal_q(signal_info(k)), 40) << k;
    }
  }
}

TEST_F(Scales, ANumberIsShownInUsersUnits) {
  EXPECT_EQ(quantity(10 << 20, UNIT_A, 20, 2), "10.00");
  parameters.current_scale = 5;
  EXPECT_EQ(quantity(10 << 20, UNIT_A, 20, 2), "320.00");
  EXPECT_EQ(quantity(1 << 20, UNIT_MH, 20, 3), "0.03125") << "two decimals more: 32 is a digit and a half";
  parameters.voltage_scale = -2;
  EXPECT_EQ(quantity(300 << 16, UNIT_V, 16, 1), "75.00");
  EXPECT_EQ(quantity(1 << 24, UNIT_KGM2, 24, 6), "8.000000");
  EXPECT_EQ(quantity(1 << 24, UNIT_A_PER_V, 24, 2), "128.00");
  EXPECT_EQ(quantity(1 << 8, UNIT_RPM, 8, 0), "1") << "time is as it was";
  parameters.current_scale = parameters.voltage_scale = -6;
  EXPECT_EQ(quantity(1 << 24, UNIT_KGM2, 24, 6), "0.000244141") << "nine decimals are all there are";
}

TEST_F(Scales, TheConsoleTakesAndShowsUsersUnits) {
  EXPECT_TRUE(has(command("set current_scale 5"), "current_scale = 5"));
  EXPECT_EQ(parameters.current_limit, 14 << 20) << "its share of the range is what it was";
  EXPECT_TRUE(has(command("get current_limit"), "current_limit = 448.00 A"));
  EXPECT_TRUE(has(command("get current_limit"), "16.00 .. 3200.00 A"));
  EXPECT_TRUE(has(command("set current_limit 400 A"), "current_limit = 400.00 A"));
  EXPECT_EQ(parameters.current_limit, (400 << 20) / 32);
  EXPECT_TRUE(has(command("set current_limit 10 A"), "is outside of 16.00 .. 3200.00 A"));
  EXPECT_TRUE(has(command("set voltage_scale -4"), "voltage_scale = -4"));
  EXPECT_TRUE(has(command("set stator_resistance 0.003"), "stator_resistance = 0.0030000 ohm"));
  EXPECT_NEAR(parameters.stator_resistance, 0.003 * 512 * (1 << 24), 256);
  EXPECT_TRUE(has(command("status"), "V\r\n"));
}

// Of numbers as people write them, at the finest format that there is.
TEST_F(Scales, ANumberBeyond31BitsOfFractionIsRead) {
  for (const char* typed : {"0.000005", "5e-6", "0.000030517", "-0.00003", "0"}) {
    std::vector<std::uint16_t> octets(typed, typed + std::strlen(typed));
    decimal_t number;
    ASSERT_EQ(text_number(octets.data(), static_cast<std::uint16_t>(octets.size()), &number), octets.size());
    for (const unsigned q : {32u, 33u, 36u, 40u}) {
      std::int32_t raw = 0;
      const double exact = std::ldexp(std::atof(typed), static_cast<int>(q));
      const bool fits = std::abs(exact) < 2147483647.0;
      EXPECT_EQ(decimal_raw(&number, static_cast<std::uint16_t>(q), &raw), fits) << typed << " q" << q;
      if (fits) {
        EXPECT_NEAR(raw, exact, 0.5 + 1e-6) << typed << " q" << q;
      }
    }
  }
  const std::uint16_t large[] = {'9', '9', '9'};
  decimal_t number;
  std::int32_t raw = 0;
  ASSERT_EQ(text_number(large, 3, &number), 3);
  EXPECT_FALSE(decimal_raw(&number, 40, &raw));
  for (const std::int32_t digits : {5'000'000, -5'000'000}) {
    number = {digits, 0};
    EXPECT_FALSE(decimal_raw(&number, 40, &raw)) << "beyond the format before it is made";
  }
}

}  // namespace

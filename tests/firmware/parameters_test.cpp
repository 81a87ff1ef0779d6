// The parameter table: its rows against a second reading of the list in double precision, and access by number.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/inside.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/mode.h"
#include "hal/hal_board.h"
}

namespace {

struct Row {
  int id;
  std::string name;
  int q, decimals;
  double minimum, maximum, initial;
  std::int32_t* value;
  bool always;
};

constexpr bool STOPPED = false, ALWAYS = true;

#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  {id, #name, q, decimals, minimum, maximum, initial, &parameters.name, access},
const Row kListed[] = {
#include "firmware/dictionary/all_parameters.h"
};
#undef PARAMETER

std::vector<Row> of_the_edition() {
  std::vector<Row> rows;
  for (const Row& r : kListed) {
    if (!parameter_is_left_out(static_cast<std::uint16_t>(r.id))) rows.push_back(r);
  }
  return rows;
}
const std::vector<Row> kRows = of_the_edition();

double exact(double value, const Row& r) { return std::ldexp(value / std::pow(10.0, r.decimals), r.q); }

class Parameters : public testing::Test {
 protected:
  void SetUp() override { drive_reset(); }
  void TearDown() override { drive_reset(); }
};

TEST_F(Parameters, NumbersAndNamesAreUnique) {
  std::set<int> ids;
  std::set<std::string> names;
  for (const Row& r : kListed) {
    EXPECT_TRUE(ids.insert(r.id).second) << r.id;
    EXPECT_TRUE(names.insert(r.name).second) << r.name;
    EXPECT_GT(r.id, 0);
  }
  EXPECT_EQ(parameter_count(), std::size(kRows));
}

TEST_F(Parameters, RawValuesAreTheRoundedOnes) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const Row& r = kRows[k];
    const parameter_info_t* const info = parameter_info(k);
    ASSERT_NE(info, nullptr);
    EXPECT_EQ(info->id, r.id);
    EXPECT_EQ(stillspin::bench::text_of(parameter_name(info)), r.name);
    EXPECT_EQ(info->q, r.q) << r.name;
    EXPECT_EQ(info->decimals, r.decimals) << r.name;
    EXPECT_EQ(info->access, r.always ? PARAMETER_ALWAYS : PARAMETER_STOPPED) << r.name;
    EXPECT_GT(stillspin::bench::text_of(parameter_meaning(info)).size(), 3u) << r.name;
    const std::pair<std::int32_t, double> pairs[] = {{parameter_minimum(info), r.minimum},
                                                     {parameter_maximum(info), r.maximum},
                                                     {parameter_initial(info), r.initial}};
    for (const auto& [raw, decimal] : pairs) {
      const double wanted = exact(decimal, r);
      ASSERT_LE(std::fabs(wanted), 2147483647.0) << r.name << " does not fit";
      // half an LSB of rounding, exact halves either way
      EXPECT_LE(std::fabs(raw - wanted), 0.5 + 1e-6) << r.name;
    }
  }
}

TEST_F(Parameters, DefaultsLieInsideTheRanges) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    EXPECT_LT(parameter_minimum(info), parameter_maximum(info)) << stillspin::bench::text_of(parameter_name(info));
    EXPECT_LE(parameter_minimum(info), parameter_initial(info)) << stillspin::bench::text_of(parameter_name(info));
    EXPECT_LE(parameter_initial(info), parameter_maximum(info)) << stillspin::bench::text_of(parameter_name(info));
    EXPECT_EQ(parameter_get(info->id), parameter_initial(info)) << stillspin::bench::text_of(parameter_name(info));
    EXPECT_EQ(*kRows[k].value, parameter_initial(info)) << stillspin::bench::text_of(parameter_name(info));
  }
}

// No module asks what its configuration may hold (control/, svpwm/): its header says so, and the table keeps within.
// What joins two of them is a rule (firmware/config/rules.c).
TEST_F(Parameters, RangesLieWithinThoseOfTheModules) {
  const struct {
    std::int32_t parameters_t::* parameter;
    double low, high;  // in the parameter's unit
  } modules[] = {
      {&parameters_t::stator_resistance, 0.001, 50.0 - 1.0},  // and the devices' on-state resistance
      {&parameters_t::device_resistance, 0.0, 1.0},
      {&parameters_t::inductance_d, 0.0334, 500.0},
      {&parameters_t::inductance_q, 0.0334, 500.0},
      {&parameters_t::magnet_flux, 0.001, 1.0},
      {&parameters_t::inertia, 1e-5, 1.0},
      {&parameters_t::pole_pairs, 1.0, 30.0},
      {&parameters_t::friction, 0.0, 1.0},
      {&parameters_t::speed_alpha, 1.0, 100000.0},
      {&parameters_t::speed_trajectory, 1.0, 200.0},
      {&parameters_t::speed_pi_bandwidth, 1.0, 200.0},
      {&parameters_t::speed_pi_damping, 0.3, 60.0},
      {&parameters_t::current_bandwidth, 100.0, 2600.0},
      {&parameters_t::current_divider, 1.0, 2.0},
      {&parameters_t::pulse_time, 15.0, 47.0},
      {&parameters_t::window_minimum, 5.0, 30.0},
      {&parameters_t::window_maximum, 5.0, 40.0},
      {&parameters_t::zero_time, 0.0, 50.0},
      {&parameters_t::settle_time, 4.0, 25.0},  // SAMPLING_SETTLE_MIN_TICKS
  };
  for (const auto& m : modules) {
    const auto is_its = [&](const Row& row) { return row.value == &(parameters.*m.parameter); };
    const Row& r = *std::find_if(kRows.begin(), kRows.end(), is_its);
    EXPECT_GE(r.minimum / std::pow(10.0, r.decimals), m.low * (1.0 - 1e-9)) << r.name;
    EXPECT_LE(r.maximum / std::pow(10.0, r.decimals), m.high * (1.0 + 1e-9)) << r.name;
  }
}

TEST_F(Parameters, SetAndGet) {
  for (const Row& r : kRows) {
    const parameter_info_t* const info = parameter_info(static_cast<std::uint16_t>(&r - kRows.data()));
    for (const std::int32_t raw : {parameter_minimum(info), parameter_maximum(info), parameter_minimum(info) + 1}) {
      stillspin::test::inside::withdraw_reload();
      ASSERT_EQ(parameter_set(info->id, raw), SET_OK) << r.name;
      EXPECT_EQ(parameter_get(info->id), raw) << r.name;
      EXPECT_EQ(*r.value, raw) << r.name;
      EXPECT_TRUE(stillspin::test::inside::reload_requested()) << r.name;
    }
  }
  parameters_reset(&parameters);
  for (const Row& r : kRows) EXPECT_NEAR(*r.value, exact(r.initial, r), 0.500001) << r.name;
}

TEST_F(Parameters, ARefusedValueChangesNothing) {
  for (const Row& r : kRows) {
    const parameter_info_t* const info = parameter_info(static_cast<std::uint16_t>(&r - kRows.data()));
    for (const std::int32_t raw :
         {parameter_minimum(info) - 1, parameter_maximum(info) + 1, std::numeric_limits<std::int32_t>::min(),
          std::numeric_limits<std::int32_t>::max()}) {
      stillspin::test::inside::withdraw_reload();
      EXPECT_EQ(parameter_set(info->id, raw), SET_RANGE) << r.name;
      EXPECT_EQ(parameter_get(info->id), parameter_initial(info)) << r.name;
      EXPECT_FALSE(stillspin::test::inside::reload_requested()) << r.name;
    }
  }
}

TEST_F(Parameters, UnknownNumbers) {
  std::set<int> known;
  for (const Row& r : kListed) known.insert(r.id);
  for (int id = 0; id <= 0xFFFF; ++id) {
    if (known.count(id) != 0) continue;
    ASSERT_EQ(parameter_set(static_cast<std::uint16_t>(id), 1), SET_UNKNOWN) << id;
    ASSERT_EQ(parameter_get(static_cast<std::uint16_t>(id)), 0) << id;
  }
  EXPECT_FALSE(stillspin::test::inside::reload_requested());
  EXPECT_EQ(parameter_info(parameter_count()), nullptr);
  EXPECT_EQ(parameter_info(0xFFFF), nullptr);
}

// With the power stage on, what the running drive was set up with stays.
TEST_F(Parameters, RefusedWhileEnergised) {
  const drive_state_t all[] = {DRIVE_BOOT, DRIVE_CALIBRATE, DRIVE_READY, DRIVE_START,
                               DRIVE_RUN,  DRIVE_STOP,      DRIVE_FAULT};
  for (const drive_state_t state : all) {
    const bool energised = state == DRIVE_START || state == DRIVE_RUN || state == DRIVE_STOP;
    stillspin::test::inside::be_in(state);
    EXPECT_EQ(drive_is_energised(), energised) << state;
    for (const Row& r : kRows) {
      const parameter_info_t* const info = parameter_info(static_cast<std::uint16_t>(&r - kRows.data()));
      parameters_reset(&parameters);
      const bool allowed = r.always || !energised;
      EXPECT_EQ(parameter_set(info->id, parameter_minimum(info)), allowed ? SET_OK : SET_RUNNING) << r.name;
      EXPECT_EQ(parameter_get(info->id), allowed ? parameter_minimum(info) : parameter_initial(info)) << r.name;
    }
  }
}

TEST_F(Parameters, AnIdThatThereIsNotWritesNothing) {
  const parameters_t before = parameters;
  EXPECT_EQ(parameter_set(0xFFFF, 1), SET_UNKNOWN);
  EXPECT_EQ(std::memcmp(&before, &parameters, sizeof before), 0);
}

}  // namespace

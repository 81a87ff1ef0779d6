// What another firmware has saved: an older one, a newer one, with other parameters or another format.

#include <algorithm>

#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/interfaces/source.h"
#include "sim_host/bench/texts.hpp"
#include "tests/firmware/store.hpp"

namespace {

using namespace stillspin;
using namespace stillspin::test;

TEST_F(Store, AnOlderFirmwareHadFewerParameters) {
  Image image;
  image.entries = table();
  image.entries.resize(20);
  entry(image, 8).raw = 12 << 20;  // current_limit
  put(0, image);
  EXPECT_EQ(power_on(), STORE_MIGRATED);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
  EXPECT_EQ(store_report()->missing, parameter_count() - 20);
  EXPECT_EQ(store_report()->values, 20);
  Values expected = defaults();
  expected[8] = 12 << 20;
  EXPECT_EQ(in_force(), expected);
  save();
  EXPECT_EQ(power_on(), STORE_LOADED);
}

// A firmware that knew no rated current watched no overload unless somebody had set it to.
TEST_F(Store, AnOverloadThatNobodyHasSetIsWatchedFromNowOn) {
  constexpr std::uint16_t kRated = 520, kOverload = 412;
  const auto overload_of = [&](bool rated, std::int32_t stored) {
    Image image;
    image.entries = table();
    for (slot_entry_t& e : image.entries) {
      if (e.id == kOverload) e.raw = stored;
    }
    const auto is_rated = [](const slot_entry_t& e) { return e.id == kRated; };
    auto& entries = image.entries;
    if (!rated) entries.erase(std::remove_if(entries.begin(), entries.end(), is_rated), entries.end());
    put(0, image);
    EXPECT_EQ(power_on(), rated ? STORE_LOADED : STORE_MIGRATED);
    return parameters.overload_current;
  };
  EXPECT_LT(overload_of(false, 0), 0) << "the motor's";
  EXPECT_EQ(parameters.rated_current, 0);
  EXPECT_EQ(overload_of(false, 5 << 20), 5 << 20);
  EXPECT_EQ(overload_of(true, 0), 0) << "somebody wants that";
}

TEST_F(Store, OrderDoesNotMatter) {
  Image image;
  image.entries = table();
  entry(image, 8).raw = 12 << 20;
  std::reverse(image.entries.begin(), image.entries.end());
  put(1, image);
  EXPECT_EQ(power_on(), STORE_LOADED);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
}

TEST_F(Store, AChangedFormatIsRescaled) {
  struct Case {
    std::uint16_t id, q;
    std::int32_t raw, expected;
  };
  for (const Case& c : {Case{8, 8, 12 << 8, 12 << 20}, Case{8, 24, (12 << 24) + 7, 12 << 20},
                        Case{8, 24, (12 << 24) + 8, (12 << 20) + 1}, Case{119, 24, -(1 << 20), -(1 << 16)},
                        Case{1, 8, 3 << 8, 3}, Case{119, 21, -3, -1}, Case{119, 21, -1, 0}}) {
    Image image;
    image.entries = table();
    for (slot_entry_t& e : image.entries) {
      if (e.id == c.id) e = {c.id, c.q, c.raw};
    }
    put(0, image);
    EXPECT_EQ(power_on(), STORE_MIGRATED);
    EXPECT_EQ(parameter_get(c.id), c.expected) << c.id << " q" << c.q;
    EXPECT_EQ(store_report()->rescaled, 1);
    EXPECT_EQ(store_report()->refused, 0);
  }
}

// A source that the edition has not is refused whatever the format; `of` is in this one.
bool is_in_edition(const parameter_info_t* of, std::int32_t raw) {
  return bench::text_of(parameter_name(of)) != "position_source" || position_sources[raw] != nullptr;
}

// The limits themselves survive every change of format, in spite of two roundings.
TEST_F(Store, LimitsSurviveAChangeOfFormat) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    for (std::uint16_t q = 0; q <= 31; ++q) {
      for (const std::int32_t limit : {parameter_minimum(info), parameter_maximum(info)}) {
        const double exact = std::ldexp(double(limit), int(q) - int(info->q));
        if (std::fabs(exact) > 2147483646.0 || !is_in_edition(info, limit)) continue;
        const slot_entry_t entry = {info->id, q, static_cast<std::int32_t>(std::floor(exact + 0.5))};
        values_reset();
        ASSERT_NE(values_put(&entry), VALUE_REFUSED) << bench::text_of(parameter_name(info)) << " q" << q;
        const std::int32_t raw = values_entry(k).raw;
        ASSERT_GE(raw, parameter_minimum(info));
        ASSERT_LE(raw, parameter_maximum(info));
        ASSERT_LE(std::fabs(double(raw) - limit), std::ldexp(1.0, std::max(0, int(info->q) - int(q))));
      }
    }
  }
}

// A limit in the coarser of two formats may be one step beyond that in the finer one: such a value is the limit.
TEST_F(Store, AStepOfTheCoarserFormatBeyondALimitIsTheLimit) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    for (int q = 0; q <= 31; ++q) {
      if (q == info->q) continue;
      const int more = q - info->q;
      for (const bool upper : {false, true}) {
        const std::int32_t limit = upper ? parameter_maximum(info) : parameter_minimum(info);
        if (!is_in_edition(info, limit)) continue;
        const double away = (upper ? 1.0 : -1.0) * std::ldexp(1.0, std::max(0, more));
        const double exact = std::ldexp(double(limit), more);
        const double at = upper ? std::floor(exact) : std::ceil(exact);
        if (std::fabs(at) + 3.0 * std::fabs(away) > 2147483646.0) continue;
        const auto put_at = [&](double raw) {
          const slot_entry_t entry = {info->id, static_cast<std::uint16_t>(q), static_cast<std::int32_t>(raw)};
          values_reset();
          return values_put(&entry);
        };
        ASSERT_EQ(put_at(at + away), VALUE_RESCALED) << bench::text_of(parameter_name(info)) << " q" << q;
        ASSERT_EQ(values_entry(k).raw, limit) << bench::text_of(parameter_name(info)) << " q" << q;
        ASSERT_EQ(put_at(at + 3.0 * away), VALUE_REFUSED) << bench::text_of(parameter_name(info)) << " q" << q;
      }
    }
  }
}

TEST_F(Store, NoParameterHasMoreThan31FractionalBits) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    for (const std::uint16_t q : {32, 40, 63, 64, 255}) {
      const slot_entry_t entry = {info->id, q, 0};
      EXPECT_EQ(values_put(&entry), VALUE_REFUSED) << bench::text_of(parameter_name(info)) << " q" << q;
    }
    const slot_entry_t finest = {info->id, 31, 0};
    if (parameter_minimum(info) <= 0 && parameter_maximum(info) >= 0) {
      EXPECT_EQ(values_put(&finest), VALUE_RESCALED) << bench::text_of(parameter_name(info));
    }
  }
}

TEST_F(Store, WhatIsOutOfItsRangeIsRefused) {
  Image image;
  image.entries = table();
  for (slot_entry_t& e : image.entries) {
    if (e.id == 8) e.raw = 101 << 20;         // current_limit, at most 100 A
    if (e.id == 60) e.raw = 9;                // position_source, at most 8
    if (e.id == 25) e = {25, 0, 2147483647};  // does not fit 32 bits any more
    if (e.id == 41) e.q = 32;                 // no format at all
  }
  put(0, image);
  EXPECT_EQ(power_on(), STORE_MIGRATED);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(store_report()->refused, 4);
  EXPECT_EQ(store_report()->first_refused, 8);
}

TEST_F(Store, UnknownNumbersAreKept) {
  for (const unsigned count : {1u, 7u, 8u, 9u, 100u, SLOT_ENTRIES_MAX - parameter_count()}) {
    SetUp();
    Image image;
    image.entries = table();
    std::vector<slot_entry_t> foreign;
    for (unsigned k = 0; k < count; ++k) {
      foreign.push_back(
          {static_cast<std::uint16_t>(1000 + k), static_cast<std::uint16_t>(k % 32), int(k * 77777) - 99});
      image.entries.insert(image.entries.begin() + std::min<int>(int(3 * k), int(image.entries.size())),
                           foreign.back());
    }
    put(1, image);
    EXPECT_EQ(power_on(), STORE_MIGRATED);
    EXPECT_EQ(store_report()->unknown, count);
    EXPECT_EQ(store_report()->values, parameter_count() + count);
    EXPECT_EQ(store_report()->missing, 0);
    for (int n = 0; n < 3; ++n) {
      set_variant(n + 1);
      ASSERT_EQ(save(), STORE_SAVED);
      EXPECT_EQ(store_report()->unknown, count);
      const std::vector<slot_entry_t> now = entries_of(store_report()->slot);
      ASSERT_EQ(now.size(), parameter_count() + count);
      for (unsigned k = 0; k < count; ++k) {
        EXPECT_EQ(now[parameter_count() + k].id, foreign[k].id);
        EXPECT_EQ(now[parameter_count() + k].q, foreign[k].q);
        EXPECT_EQ(now[parameter_count() + k].raw, foreign[k].raw);
      }
    }
    EXPECT_EQ(power_on(), STORE_MIGRATED);
  }
}

// What one firmware knows and the other does not is counted either way, and neither hides the other.
TEST_F(Store, UnknownNumbersDoNotStandForMissingOnes) {
  for (const unsigned unknown : {1u, 12u, 30u}) {
    Image image;
    image.entries = table();
    image.entries.resize(parameter_count() - 12);
    for (unsigned k = 0; k < unknown; ++k) image.entries.push_back({static_cast<std::uint16_t>(1000 + k), 0, 7});
    put(0, image);
    EXPECT_EQ(power_on(), STORE_MIGRATED);
    EXPECT_EQ(store_report()->unknown, unknown);
    EXPECT_EQ(store_report()->missing, 12);
    EXPECT_EQ(store_report()->refused, 0);
  }
}

TEST_F(Store, MoreUnknownNumbersThanThereIsRoomForAreNotGivenUp) {
  Image image;
  for (unsigned k = 0; k < SLOT_ENTRIES_MAX; ++k) image.entries.push_back({static_cast<std::uint16_t>(1000 + k), 0, 0});
  put(0, image);
  EXPECT_EQ(power_on(), STORE_MIGRATED);
  EXPECT_EQ(save(), STORE_FAILED);
  EXPECT_EQ(nvm.pages, 0);
}

TEST_F(Store, ANewerFormatIsToldFromDamage) {
  Image image;
  image.version = SLOT_VERSION + 1;
  image.sequence = 41;
  image.entries = table();
  put(0, image);
  EXPECT_EQ(power_on(), STORE_FOREIGN);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(save(), STORE_SAVED);
  EXPECT_EQ(store_report()->sequence, 42u);
  EXPECT_EQ(power_on(), STORE_LOADED);
  nvm.memory[30] ^= 1;
  nvm.memory[SLOT_SIZE] ^= 1;
  EXPECT_EQ(power_on(), STORE_DAMAGED);
}

TEST_F(Store, OlderValuesAreBetterThanNone) {
  Image image;
  image.entries = table();
  entry(image, 8).raw = 12 << 20;
  put(0, image);
  image.version = SLOT_VERSION + 1;
  image.sequence = 2;
  put(1, image);
  EXPECT_EQ(power_on(), STORE_OLDER);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
}

// The set of the newer firmware is the newest one: the save goes over the older one, and the next over that.
TEST_F(Store, ASaveSparesWhatANewerFirmwareSavedLast) {
  for (const unsigned foreign : {0u, 1u}) {
    nvm = FakeNvm{};
    Image image;
    image.entries = table();
    image.entries.push_back({9999, 0, 5});
    put(1 - foreign, image);
    image.version = SLOT_VERSION + 1;
    image.sequence = 2;
    put(foreign, image);
    const auto at = nvm.memory.begin() + foreign * SLOT_SIZE;
    const std::vector<std::uint8_t> kept(at, at + SLOT_SIZE);
    EXPECT_EQ(power_on(), STORE_OLDER);
    EXPECT_EQ(save(), STORE_SAVED);
    EXPECT_EQ(store_report()->slot, 1 - foreign);
    EXPECT_EQ(store_report()->sequence, 3u);
    EXPECT_TRUE(std::equal(kept.begin(), kept.end(), nvm.memory.begin() + foreign * SLOT_SIZE));
    EXPECT_EQ(power_on(), STORE_LOADED);
  }
}

TEST_F(Store, ValuesThatDoNotFitTogetherAreNotUsed) {
  Image image;
  image.entries = table();
  for (slot_entry_t& e : image.entries) {
    if (e.id == 8) e.raw = 15 << 20;         // current_limit: fine for itself
    if (e.id == 30) e.raw = (14 << 20) + 1;  // trip_current below it
  }
  put(0, image);
  EXPECT_EQ(power_on(), STORE_CONFLICT);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
}

}  // namespace

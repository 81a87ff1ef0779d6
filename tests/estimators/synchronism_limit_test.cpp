// The limit of the voltage left over, and how fast the debounce counter grows beyond it.

#include <gtest/gtest.h>

#include "tests/estimators/synchronism_scene.hpp"

namespace {

using namespace stillspin::test;
using namespace stillspin::test::frames;

// The floor is meant for windows of half a period; it grows with the square of what they are shorter, and the EMF's
// share comes on top in either direction.
TEST(SynchronismLimit, TheLimitGrowsWithShortWindowsAndSpeed) {
  Scene scene;
  for (const auto& [span, factor] : {std::pair{9000, 1.0}, {5000, 1.0}, {2500, 4.0}, {1250, 16.0}}) {
    for (const double w : {0.0, 300.0, -300.0}) {
      const synchronism_seen_t seen = seen_of({0.0, 0.0}, w, span, 5);
      for (int n = 0; n < 30; ++n) (void)synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0);
      EXPECT_NEAR(real(scene.s.limit_q16, 16), kFloor * factor + kShare * std::fabs(w) * kMotor.flux, 0.01) << span;
    }
  }
}

// At the limit there is no loss, a little beyond there is one; both axes count.
TEST(SynchronismLimit, TheLimitIsOfTheWholeVector) {
  for (const double part : {0.99, 1.01}) {
    Scene scene;
    const Vector emf = Vector{0.6, 0.8} * (kFloor * part);
    const synchronism_seen_t seen = seen_of(emf, 0.0, 5000, 3);
    for (int n = 0; n < 200; ++n) (void)synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0);
    EXPECT_EQ(scene.s.debounce > 0, part > 1.0) << part;
  }
}

/// What one judgement of five periods adds while the error is `share` of the limit at rest.
std::int32_t debounce_at(double share) {
  Scene scene;
  const Vector emf = Vector{-0.6, 0.8} * (kFloor * share);
  scene.s.error_q16 = raw_dq(emf, 16);
  const synchronism_seen_t seen = seen_of(emf, 0.0, 5000, 5);
  (void)synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0);
  return scene.s.debounce;
}

// 8 e^2 / limit^2 for each period, rounded down.
TEST(SynchronismLimit, DoubtGrowsWithTheSquareOfTheError) {
  EXPECT_EQ(debounce_at(0.995), 0);
  EXPECT_EQ(debounce_at(1.005), 40);
  EXPECT_EQ(debounce_at(std::sqrt(1.51)), 60);
  EXPECT_EQ(debounce_at(std::sqrt(2.02)), 80);
}

// A limit as it may be set, and one that short windows make: the squares stay in their format.
TEST(SynchronismLimit, SmallAndLargeLimitsDoubtAlike) {
  for (const auto& [limit, span, top] : {std::tuple{0.5, 5000, 0.5}, {100.0, 5000, 100.0}, {100.0, 300, 500.0}}) {
    Scene scene;
    const synchronism_config_t c = {raw(limit, 16), 0, kBad};
    const Vector emf = {0.0, top * std::sqrt(2.1)};
    scene.s.error_q16 = raw_dq(emf, 16);
    const synchronism_seen_t seen = seen_of(emf, 0.0, span, 1);
    (void)synchronism_judge(&scene.s, &c, &scene.model, &seen, 0);
    EXPECT_NEAR(real(scene.s.limit_q16, 16), top, 0.01);
    EXPECT_NEAR(scene.s.debounce, 8 * 2.1, 1.5) << limit;  // 256 parts of the square at half a volt
  }
}

// Without a floor nothing is borne at rest, and nothing is divided by.
TEST(SynchronismLimit, ALimitOfNothingIsOne) {
  Scene scene;
  const synchronism_config_t c = {0, 0, kBad};
  scene.s.error_q16 = {raw(1.0, 16), 0};
  const synchronism_seen_t seen = seen_of({0.0, 0.0}, 0.0, 5000, 1);
  EXPECT_TRUE(synchronism_judge(&scene.s, &c, &scene.model, &seen, 0));
  EXPECT_EQ(scene.s.limit_q16, 0);
}

}  // namespace

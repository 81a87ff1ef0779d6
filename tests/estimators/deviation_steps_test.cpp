// What the deviation observer does in one step beside filtering: steps of the load that it admits, what it leaves to
// others, its design, and how sure it says it is.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/deviation_observer.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

constexpr double kCrawl = 40.0;  // rad/s
constexpr int kOne = 1 << 20;    // a variance of one, in own units

class Observer {
 public:
  explicit Observer(bool steps_at_speed = true, double speed = 0.0) {
    const deviation_observer_tuning_t tuning = {raw(0.1, 20), raw(0.6, 20), raw(0.05, 20),
                                                raw(1.0, 20), bpp(kCrawl),  steps_at_speed};
    deviation_observer_design(&config, &model, &tuning);
    config.cogging = {0, config.cogging.crawl_bpp, 0};
    deviation_observer_preset(&state, 0, bpp(speed), 0);
    state.p_aa = state.p_ss = state.p_ll = kOne;  // far below the limits
  }
  /// The angle's scores lean as they do behind a step of the load.
  void suggest_step() { state.mean_score_q20 = 100 * kOne; }
  void rest() { state.mean_score_q20 = 0; }
  estimator_output_t step(bool renew = true, bool busy = false) {
    const estimator_input_t blind = {&model, nullptr, 0, 0, false, renew, false, busy, nullptr, 0};
    return deviation_observer_step(&state, &config, &blind);
  }

  machine_model_t model = model_of(Motor{});
  deviation_observer_config_t config = {};
  deviation_observer_t state = {};
};

// A load that changed some time ago, by an unknown amount of this variance, has moved speed and angle with it: by age
// and age^2 / 2 of it. louder: what the load's variance gains in this period because it is not quiet any more.
void expect_admitted(Observer with, double variance, double louder, double age, const char* what) {
  Observer without = with;
  with.suggest_step();
  (void)with.step();
  (void)without.step();
  const auto more = [&](std::int32_t deviation_observer_t::* p) {
    return static_cast<double>(with.state.*p) - without.state.*p;
  };
  EXPECT_NEAR(more(&deviation_observer_t::p_ll), variance + louder, 1e-5 * variance + 40.0) << what;
  EXPECT_NEAR(more(&deviation_observer_t::p_sl), variance * age, 1e-5 * variance + 40.0) << what;
  EXPECT_NEAR(more(&deviation_observer_t::p_ss), variance * age * age, 1e-5 * variance + 40.0) << what;
  EXPECT_NEAR(more(&deviation_observer_t::p_al), variance * age * age / 2.0, 1e-5 * variance + 40.0) << what;
  EXPECT_NEAR(more(&deviation_observer_t::p_as), variance * std::pow(age, 3) / 2.0, 1e-5 * variance + 40.0) << what;
  EXPECT_NEAR(more(&deviation_observer_t::p_aa), variance * std::pow(age, 4) / 4.0, 1e-5 * variance + 40.0) << what;
}

TEST(DeviationSteps, AStepOfTheLoadIsAdmittedAsLongAsItHasActed) {
  for (const double sign : {1.0, -1.0}) {
    const auto at = [&](double crawls, bool mapped) { return Observer(mapped, sign * crawls * kCrawl); };
    const Observer slow = at(0.5, true);
    const double small = slow.config.load_step_q20, large = slow.config.moving_step_q20;
    const double louder = slow.config.load_noise_q20 - slow.config.load_noise_quiet_q20;
    expect_admitted(slow, small, louder, 0.25, "at a crawl");
    expect_admitted(at(2.0, true), 0.5 * (small + large), 0.5 * louder, 0.25, "between");
    expect_admitted(at(3.1, true), large, 0.0, 0.25, "at speed");
    expect_admitted(at(0.5, false), small, louder, 0.5, "unmapped");
    expect_admitted(at(3.1, false), 0.0, 0.0, 0.5, "unmapped at speed");
  }
}

// Again after 11 ms at a crawl, where the boost has faded to 0.8, and after 150 ms at speed, to 0.05; it loses one part
// in 512 a period.
TEST(DeviationSteps, AStepIsAdmittedAgainAfterAWhileOnly) {
  struct Case {
    double crawls, left;
  };
  for (const Case& c : {Case{0.5, 0.8}, Case{4.0, 0.05}}) {
    Observer o(true, c.crawls * kCrawl);
    o.suggest_step();
    (void)o.step();
    ASSERT_NEAR(real(o.state.noise_boost_q30, 30), 1.0, 1e-6);
    int periods = 0;
    std::int32_t before = 0;
    do {
      before = o.state.noise_boost_q30;
      o.state.p_aa = o.state.p_ss = o.state.p_ll = kOne;
      o.suggest_step();
      (void)o.step();
      ++periods;
    } while (o.state.noise_boost_q30 < before && periods < 5000);
    EXPECT_NEAR(periods, std::log(c.left) / std::log(1.0 - 1.0 / 512.0), 2.0) << c.crawls;
  }
}

// An angle that is not known is not waited with, but for the period in which the model moves; twelve periods at most.
TEST(DeviationSteps, ACovarianceThatNobodyAskedForWaitsForTheModel) {
  Observer o;
  o.state.p_aa = 100 * kOne;
  ASSERT_FALSE(deviation_observer_is_sure(&o.state));
  (void)o.step(false);
  EXPECT_EQ(o.state.gathered.periods, 0) << "renewed";
  for (int waited = 1; waited < 12; ++waited) {
    (void)o.step(false, true);
    ASSERT_EQ(o.state.gathered.periods, waited);
  }
  (void)o.step(false, true);
  EXPECT_EQ(o.state.gathered.periods, 0);
  (void)o.step(true, true);
  EXPECT_EQ(o.state.gathered.periods, 0) << "asked for";
}

// A suspicion that comes while the covariance is not renewed is kept until it is, and says that it should be.
TEST(DeviationSteps, ALeanWaitsForTheRenewal) {
  Observer o;
  EXPECT_FALSE(deviation_observer_is_due(&o.state));
  o.suggest_step();
  (void)o.step(false);
  EXPECT_TRUE(o.state.load_step_suspected);
  EXPECT_TRUE(deviation_observer_is_due(&o.state));
  EXPECT_EQ(o.state.noise_boost_q30, 0);
  o.rest();
  (void)o.step(false);
  EXPECT_TRUE(o.state.load_is_new);
  EXPECT_EQ(o.state.noise_boost_q30, 0);
  (void)o.step();
  EXPECT_NEAR(real(o.state.noise_boost_q30, 30), 1.0, 1e-6);
  EXPECT_FALSE(o.state.load_step_suspected);
  (void)o.step();
  EXPECT_TRUE(o.state.load_is_new);  // within 11 ms
  for (int n = 0; n < 120; ++n) (void)o.step();
  EXPECT_FALSE(o.state.load_is_new);
}

// With nobody looking out for steps at speed, a suspicion there is none of its business.
TEST(DeviationSteps, AtSpeedWithoutTheMapNothingIsLookedOutFor) {
  Observer o(false, 1.5 * kCrawl);
  o.suggest_step();
  (void)o.step(false);
  EXPECT_FALSE(o.state.load_is_new);
  Observer crawling(false, kCrawl);
  crawling.suggest_step();
  (void)crawling.step(false);
  EXPECT_TRUE(crawling.state.load_is_new);
}

// Scores suggest a step when the square of their mean is above 0.4 of their power.
TEST(DeviationSteps, FiveStandardDeviationsAreALean) {
  for (const double share : {0.62, 0.65}) {
    Observer o;
    const double power = 4.0;
    o.state.score_power_q23 = raw(power, 23);
    // what the step itself forgets first: a 32nd of the mean and a 256th of the power
    o.state.mean_score_q20 = raw(share * std::sqrt(power * 255.0 / 256.0) * 32.0 / 31.0, 20);
    (void)o.step(false);
    EXPECT_EQ(o.state.load_step_suspected, share > std::sqrt(0.4)) << share;
  }
}

// The power of short windows' scores is small, and a mean of it all the same: over 256 periods.
TEST(DeviationSteps, ASmallPowerIsAMean) {
  Observer o;
  o.state.score_power_q23 = 240;
  for (int n = 0; n < 256; ++n) (void)o.step();
  EXPECT_NEAR(o.state.score_power_q23, 240.0 * std::pow(255.0 / 256.0, 256), 2.0);
}

// While nothing shows that the load changes its variance grows by the quiet rate at a crawl, by the other at speed, and
// by an eighth of the quiet one where the cogging is known.
TEST(DeviationSteps, TheLoadsVarianceGrowsByItsRate) {
  const auto growth = [](Observer o) {
    const std::int32_t before = o.state.p_ll;
    for (int n = 0; n < 10; ++n) (void)o.step();
    return (o.state.p_ll - before) / 10.0;
  };
  const Observer crawling(true, 0.5 * kCrawl);
  EXPECT_NEAR(growth(crawling), crawling.config.load_noise_quiet_q20, 1.0);
  EXPECT_NEAR(growth(Observer(true, 4.0 * kCrawl)), crawling.config.load_noise_q20, 1.0);
  Observer knows = crawling;
  knows.state.cogging.known_q30 = 1 << 30;
  EXPECT_NEAR(growth(knows), crawling.config.load_noise_quiet_q20 / 8.0, 8.0);
}

// 1 N m in 10 ms is a random walk of a tenth of that a period; a step has all of it at once. In own units, of 2^-18 rad
// per period^2.
TEST(DeviationSteps, DesignInItsUnits) {
  const Motor m;
  const Observer o;
  const double unit = std::ldexp(1.0, -18);
  const auto units = [&](double nm) { return nm * m.pole_pairs / m.inertia * kPeriod * kPeriod / unit; };
  EXPECT_NEAR(o.config.load_noise_q20, std::pow(units(0.6), 2) / 100.0 * kOne, 5e-3 * o.config.load_noise_q20);
  EXPECT_NEAR(o.config.load_noise_quiet_q20, std::pow(units(0.05), 2) / 100.0 * kOne, 10.0 + 0.05 * 0.05 * kOne);
  EXPECT_NEAR(o.config.load_step_q20, std::pow(units(1.0), 2) * kOne, 5e-3 * o.config.load_step_q20);
  EXPECT_EQ(o.config.moving_step_q20, 4 * o.config.load_step_q20);  // twice the step
  EXPECT_EQ(Observer(false).config.moving_step_q20, 0);
  EXPECT_EQ(o.config.limit_q19, 96 * raw(0.1, 20));
}

// What lies below its range is taken to the range's end.
TEST(DeviationSteps, DesignKeepsAboveItsRanges) {
  const Observer o;
  const auto designed = [&](const deviation_observer_tuning_t& tuning) {
    deviation_observer_config_t c = {};
    deviation_observer_design(&c, &o.model, &tuning);
    return c;
  };
  const auto with_noise = [&](std::int32_t noise_q20) {
    return designed({noise_q20, raw(0.6, 20), raw(0.05, 20), raw(1.0, 20), 1000, true});
  };
  const double least = real(1049, 20);  // 1 mA
  for (const std::int32_t noise_q20 : {0, 1000, 1048, 1049}) {
    EXPECT_NEAR(real(with_noise(noise_q20).weight_q8, 8) * least * least, 1.0 / 3.0, 1e-5) << noise_q20;
    EXPECT_EQ(with_noise(noise_q20).limit_q19, 96 * 1049) << noise_q20;
  }
  EXPECT_EQ(with_noise(1050).limit_q19, 96 * 1050);
  EXPECT_EQ(with_noise(kOne).weight_q8, 256 / 3);
  EXPECT_EQ(with_noise(kOne).limit_q19, 96 * kOne);
  EXPECT_EQ(with_noise(kOne - 1).limit_q19, 96 * (kOne - 1));

  const auto with_loads = [&](double rate, double quiet, double step) {
    return designed({raw(0.1, 20), raw(rate, 20), raw(quiet, 20), raw(step, 20), 1000, true});
  };
  EXPECT_EQ(with_loads(0.0, 0.0, 0.0).load_noise_q20, 1) << "it may always change";
  EXPECT_EQ(with_loads(2000.0, 1.0, 1.0).load_noise_q20, INT32_MAX / 100) << "in 10 ms as much as the format holds";
  const deviation_observer_config_t louder = with_loads(0.6, 2.0, 1.0);
  EXPECT_EQ(louder.load_noise_quiet_q20, louder.load_noise_q20) << "quiet is never louder";
  EXPECT_NEAR(with_loads(0.6, 0.05, 2000.0).load_step_q20, 256.0 * kOne, 100.0);
  EXPECT_EQ(with_loads(0.6, 0.05, 2000.0).moving_step_q20, 256 * kOne);

  const auto with_crawl = [&](std::int32_t crawl_bpp) {
    return designed({raw(0.1, 20), raw(0.6, 20), raw(0.05, 20), raw(1.0, 20), crawl_bpp, true});
  };
  const struct {
    std::int32_t asked, taken;
  } crawls[] = {{-5, 1}, {0, 1}, {1, 1}, {2, 2}, {INT32_MAX / 4, INT32_MAX / 4}};
  for (const auto& crawl : crawls) {
    const deviation_observer_config_t c = with_crawl(crawl.asked);
    EXPECT_EQ(c.cogging.crawl_bpp, crawl.taken) << crawl.asked;
    EXPECT_EQ(q_over(2 * crawl.taken, c.per_crawl, 20), kOne) << crawl.asked;
  }
}

TEST(DeviationSteps, QualityIsWhatIsLeftOfTheAnglesVariance) {
  Observer o;
  for (const int variance : {1, 16, 100}) {
    o.state.p_aa = variance * kOne;
    const estimator_output_t out = o.step();
    EXPECT_EQ(out.quality_q15, 32767 - o.state.p_aa / 4096) << variance;
  }
  o.state.p_aa = 500 * kOne;
  EXPECT_EQ(o.step().quality_q15, 0);
}

// A shaft that has stood: no speed, hardly a doubt about it, and no relation to what was believed of angle and load.
TEST(DeviationSteps, AShaftThatStoodHasNoSpeed) {
  Observer o(true, 10.0);
  o.state.p_as = o.state.p_al = o.state.p_sl = 1000;
  deviation_observer_stands(&o.state);
  EXPECT_EQ(o.state.speed_bpp, 0);
  EXPECT_EQ(o.state.p_ss, kOne / 4);
  EXPECT_EQ(o.state.p_as, 0);
  EXPECT_EQ(o.state.p_sl, 0);
  EXPECT_EQ(o.state.p_al, 1000);
  EXPECT_EQ(o.state.p_aa, kOne);
}

TEST(DeviationSteps, BeginsUncertain) {
  deviation_observer_t s;
  deviation_observer_preset(&s, 5u, INT32_MIN, 7);
  EXPECT_EQ(s.angle_bam, 5u);
  EXPECT_NEAR(rad(s.speed_bpp), -1.9, 1e-6);
  EXPECT_EQ(s.load_accel_q8, 7);
  EXPECT_EQ(s.p_aa, 128 * kOne);  // (10 degrees)^2 in units of 2^-6 rad
  EXPECT_EQ(s.p_ss, 64 * kOne);
  EXPECT_EQ(s.p_ll, 64 * kOne);
  EXPECT_EQ(s.p_as | s.p_al | s.p_sl, 0);
}

// What several periods leave over is taken as the mean by spans, of windows that leave different amounts.
TEST(DeviationSteps, WhatIsLeftIsTheMeanBySpans) {
  Observer o;
  const Motor m;
  Vector sum = {0.0, 0.0};
  int ticks = 0;
  for (int n = 0; n < 3; ++n) {
    std::vector<Window> windows = {window_at(m, 0.0, 0.0, {1.0, 2.0}, state_vector(1), 2500, 1000 + 700 * n),
                                   window_at(m, 0.0, 0.0, {1.0, 2.0}, state_vector(6), 7500, 2500)};
    const Vector left[] = {{0.3, -0.2 * n}, {0.05 * n, 0.4}};
    for (std::size_t k = 0; k < 2; ++k) {
      windows[k].slope = windows[k].slope + left[k];
      sum = sum + left[k] * windows[k].span;
      ticks += windows[k].span;
    }
    const deviation_residual_t kept = o.state.residual;
    deviation_observer_preset(&o.state, 0, 0, 0);  // as if it had not corrected itself
    o.state.residual = kept;
    const Input in(o.model, windows);
    (void)deviation_observer_step(&o.state, &o.config, in.get());
  }
  dq_t residual = {};
  std::int32_t span = 0, periods = 0;
  ASSERT_TRUE(deviation_take_mean_residual(&o.state.residual, &residual, &span, &periods));
  // each period's changes are rounded to 0.49 mA
  EXPECT_NEAR(real(residual.d, 20), sum.x / ticks, 3 * 2.5e-4 * 10000 / ticks);
  EXPECT_NEAR(real(residual.q, 20), sum.y / ticks, 3 * 2.5e-4 * 10000 / ticks);
  EXPECT_EQ(span, ticks / 3);
  EXPECT_EQ(periods, 3);
  EXPECT_FALSE(deviation_take_mean_residual(&o.state.residual, &residual, &span, &periods));
}

// Of windows that nobody asks for nothing is kept: after fifteen periods it begins anew.
TEST(DeviationSteps, WhatNobodyTakesIsForgotten) {
  const Motor m;
  const std::vector<Window> windows = {window_at(m, 0.0, 0.0, {1.0, 2.0}, state_vector(1), 2500, 2500),
                                       window_at(m, 0.0, 0.0, {1.0, 2.0}, state_vector(6), 7500, 2500)};
  for (const auto& [count, kept] : {std::pair{15, 15}, {16, 1}, {17, 2}}) {
    Observer o;
    const Input in(o.model, windows);
    for (int n = 0; n < count; ++n) (void)deviation_observer_step(&o.state, &o.config, in.get());
    dq_t residual = {};
    std::int32_t span = 0, periods = 0;
    EXPECT_EQ(deviation_take_mean_residual(&o.state.residual, &residual, &span, &periods), true) << count;
    EXPECT_EQ(periods, kept);
    EXPECT_EQ(span, 5000);
  }
}

}  // namespace

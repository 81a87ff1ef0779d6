// The spin of the commissioning: what it does with the drive, and what it sums up.

#include <algorithm>
#include <cstring>

#include "tests/firmware/commissioning_phases.hpp"

namespace {

using namespace stillspin::test;

// The shaft follows its reference at once, and the observer's speed is 2 % off what the angle does, which is noisier
// than it turns in a period: three stations of 0.8 s for the voltage and a second for the torque, each to the end of a
// turn, ramps between them, and a stop.
TEST_F(Phases, TheSpinSumsStationsAndRamps) {
  std::memset(&commissioning.spin, 0x55, sizeof commissioning.spin);  // an earlier commissioning's
  inside::is_exclusive() = true;
  inside::selected() = {bam(0.4), bpp(5.0), 0, 32767};
  const std::int32_t high = bpp_of(600);
  inside::command_dq_q16() = {raw(-3.0, 16), raw(20.0, 16)};
  inside::current_dq_q20() = {raw(0.25, 20), raw(0.5, 20)};
  inside::reference_dq_q20().d = raw(1.0, 20);
  commissioning.staircase.held_q20 = raw(limit_, 20);
  int n = 0;
  std::int32_t last = 0;
  std::uint32_t turned = 0;
  EXPECT_FALSE(step(commissioning_spin)) << "what is there of an earlier one goes first";
  for (; n < 100000; ++n) {
    inside::current_dq_q20().q = raw(inside::spin_d_q20() == 0 ? 0.5 : 7.0, 20);
    EXPECT_FALSE(step(commissioning_spin));
    if (!inside::spins()) break;
    ASSERT_LE(std::abs(inside::target_bpp() - last), high / 300 + 1) << n << ": once in a millisecond";
    last = inside::ramped_bpp() = inside::target_bpp();
    inside::selected().speed_bpp = last / 50 * 49;
    turned += static_cast<std::uint32_t>(last);
    inside::selected().angle_bam = turned + static_cast<std::uint32_t>(n % 2 == 0 ? high : -high);
  }
  // ramps of 0.1, 0.2, 0.2 and 0.1 s, settling and stations, up to a turn behind each, 0.3 s at rest
  const int turn = static_cast<int>(4294967296.0 / high), least = 1000 + 2000 + 2000 + 1000 + 3 * 22192 + 3000;
  EXPECT_GT(n, least - 10);
  EXPECT_LT(n, least + 50 + 21 * turn) << "each leg ends with a millisecond";
  const spin_t& s = commissioning.spin;
  for (int k = 0; k < 3; ++k) {
    const spin_sums_t& at = s.station[k];
    ASSERT_GE(at.periods, 8192) << k;
    ASSERT_LE(at.periods, 8192 + (k == 1 ? 1 : 3) * turn) << k;
    ASSERT_GE(at.torque_periods, 10000) << k;
    ASSERT_LE(at.torque_periods, 10000 + (k == 1 ? 1 : 3) * turn) << k;
    EXPECT_NEAR(static_cast<double>(at.speed) / at.periods, k == 1 ? high : high / 3, 300.0) << k;
    const double turns = static_cast<double>(at.speed) / 4294967296.0;
    EXPECT_NEAR(turns, std::round(turns), 3.0 * high / 4294967296.0) << "whole turns";
    EXPECT_EQ(at.voltage_q, std::int64_t{at.periods} * raw(20.0, 16));
    EXPECT_EQ(at.current_q, std::int64_t{at.torque_periods} * raw(0.5, 20)) << "without i_d";
    EXPECT_EQ(at.current_d, std::int64_t{at.periods} * raw(0.25, 20));
  }
  for (const spin_sums_t& ramp : s.ramp) {
    EXPECT_GE(ramp.periods, 2000 + 4000 - 10) << "a ramp ends with a millisecond";
    EXPECT_LE(ramp.periods, 2000 + 4000 + 10 + 3 * turn);
    EXPECT_EQ(ramp.torque_periods, ramp.periods);
    EXPECT_NEAR(static_cast<double>(ramp.current_q), ramp.periods * static_cast<double>(raw(0.5, 20)),
                10 * raw(6.5, 20));
  }
  // up: 2000 periods of the mean of both speeds, the rest at the higher; down: at the lower. Steps once a millisecond
  // begin and end up to ten periods beside that.
  for (const int k : {0, 1}) {
    const double rest = (s.ramp[k].periods - 2000) / (k == 0 ? 1.0 : 3.0);
    EXPECT_NEAR(static_cast<double>(s.ramp[k].speed) / high, 2000.0 * 2.0 / 3.0 + rest, 20.0) << k;
  }

  // Held again where it came to rest, until the background level has made its motion of the sums.
  EXPECT_TRUE(commissioning.solve_motion);
  EXPECT_EQ(inside::reference_dq_q20().d, 0);
  EXPECT_EQ(commissioning.target_bam, inside::selected().angle_bam);
  EXPECT_FALSE(step(commissioning_spin));
  commissioning.torque_q24 = 123456;
  commissioning.accel_q12 = 654321;
  commissioning.solve_motion = false;
  EXPECT_TRUE(step(commissioning_spin));
  EXPECT_EQ(inside::model().torque_q24, 123456);
  EXPECT_EQ(inside::model().accel_q12, 654321);
}

// From the most to half of it and from the negative half back, once in a millisecond; none in ramps and settling, nor
// while the torque is measured, nor behind the last station. The most is a share of the current limit, what the magnets
// bear, or what holds the rotor; none where there is no saliency.
TEST_F(Phases, TheSpinHasACurrentAlongDWhileItMeasuresTheVoltage) {
  struct Case {
    double weakening, held;  // of the current limit
    bool uniform;
    double most;
  };
  for (const Case& c : {Case{1.0, 1.0, false, 3.0 / 16.0},
                        {0.05, 1.0, false, 0.05},
                        {0.0, 1.0, false, 0.0},
                        {1.0, 0.1, false, 0.1},
                        {1.0, 1.0, true, 0.0}}) {
    SetUp();
    parameters.weakening_limit = raw(c.weakening * limit_, 20);
    use_parameters();
    commissioning.staircase.held_q20 = raw(c.held * limit_, 20);
    inside::selected() = {bam(0.4), bpp(5.0), 0, 32767};
    inside::spin_d_q20() = raw(9.0, 20);  // of one that was broken off
    (void)step(commissioning_spin);
    EXPECT_EQ(inside::spin_d_q20(), 0);
    inside::is_exclusive() = true;
    commissioning.uniform = c.uniform;
    double sum = 0.0, largest = 0.0, least = limit_;
    int flows = 0;
    const spin_t& s = commissioning.spin;
    for (int n = 0; s.leg < 3 || s.tick < 100; ++n) {
      ASSERT_LT(n, 100000);
      const bool field = s.leg < 3 && s.tick >= 4000 && s.tick < 12182, turned = s.tick >= 8096;
      if (step(commissioning_spin)) break;
      inside::ramped_bpp() = inside::target_bpp();
      inside::selected().angle_bam += static_cast<std::uint32_t>(inside::target_bpp());
      if (inside::scheduled_task() != TASK_FIELD) continue;
      const double now = real(inside::spin_d_q20(), 20);
      EXPECT_EQ(now != 0.0, field && c.most > 0.0) << s.leg << ", " << s.tick;
      if (now == 0.0) continue;
      EXPECT_EQ(now < 0.0, turned) << s.tick;
      sum += now;
      largest = std::fmax(largest, std::fabs(now));
      least = std::fmin(least, std::fabs(now));
      ++flows;
    }
    // Without i_d the whole station is good for both.
    const spin_sums_t& at = s.station[1];
    if (c.most == 0.0) {
      EXPECT_EQ(at.periods, at.torque_periods) << c.weakening;
      EXPECT_GE(at.periods, 18192) << c.weakening;
      continue;
    }
    EXPECT_GE(at.periods, 8192) << c.weakening;
    EXPECT_LT(at.periods, 9000) << c.weakening;
    EXPECT_NEAR(largest, c.most * limit_, 1e-2 * c.most * limit_) << c.weakening << ", " << c.held;
    EXPECT_NEAR(least, largest / 2.0, 2e-3 * largest);
    EXPECT_GE(flows, 3 * 818);
    EXPECT_LT(std::fabs(sum / flows), 0.1 * largest) << "as much negative as positive, but for the turns' ends";
  }
}

// A brake, or a shaft that is blocked: no turn ever ends, and the current that pulls must.
TEST_F(Phases, TheSpinOfAShaftThatStandsEnds) {
  inside::is_exclusive() = true;
  inside::selected() = {bam(0.4), 0, 0, 32767};
  EXPECT_FALSE(step(commissioning_spin));
  int n = 0;
  for (; n < 300000; ++n) {
    EXPECT_FALSE(step(commissioning_spin));
    if (!inside::spins()) break;
    inside::ramped_bpp() = inside::target_bpp();
  }
  EXPECT_NEAR(n, 1000 + 2000 + 2000 + 1000 + 3 * 22192 + 3000 + 9 * 14000, 100) << "each end of a turn is waited for";
  for (const spin_sums_t& at : commissioning.spin.station) EXPECT_EQ(at.speed, 0);
  EXPECT_TRUE(commissioning.solve_motion);
}

// The start's vector brings it to speed and hands it back turning; it is not brought to rest, where nothing holds it.
TEST_F(Phases, TheSpinOfAShaftThatShowsNoAxisBeginsWithAVector) {
  commissioning.uniform = true;
  commissioning.phase = COMMISSIONING_SPIN;
  inside::target_bpp() = -bpp_of(100);  // a command of before
  EXPECT_FALSE(step(commissioning_spin));
  ASSERT_EQ(inside::state(), DRIVE_START);
  EXPECT_EQ(inside::start_phase(), START_IF_RAMP);
  EXPECT_EQ(inside::state_behind(), DRIVE_COMMISSION);
  EXPECT_TRUE(inside::is_open_loop());
  EXPECT_EQ(inside::target_bpp(), 0) << "forward";

  drive_enter(&drive, DRIVE_COMMISSION);  // as the ramp's end does it
  inside::spins() = true;
  inside::selected() = {bam(0.4), bpp_of(300), 0, 32767};
  inside::ramped_bpp() = bpp_of(300);
  inside::is_exclusive() = false;
  EXPECT_FALSE(commissioning_spin(&drive));
  EXPECT_FALSE(commissioning.spin.begun) << "in a period of its own";
  EXPECT_EQ(inside::target_bpp(), bpp_of(300)) << "and is not braked meanwhile";
  EXPECT_FALSE(step(commissioning_spin));
  EXPECT_TRUE(commissioning.spin.begun);
  EXPECT_EQ(inside::selected().speed_bpp, bpp_of(300)) << "what is known of the shaft stays";
  EXPECT_NEAR(inside::target_bpp(), bpp_of(300), bpp_of(600) / 300 + 1);
  int n = 0;
  while (!step(commissioning_spin)) {
    inside::ramped_bpp() = inside::selected().speed_bpp = inside::target_bpp();
    inside::selected().angle_bam += static_cast<std::uint32_t>(inside::target_bpp());
    ASSERT_LT(++n, 100000);
  }
  for (const spin_sums_t& at : commissioning.spin.station) EXPECT_GE(at.periods, 8192);
  EXPECT_NEAR(inside::selected().speed_bpp, bpp_of(200), 300);
  EXPECT_TRUE(inside::spins());
  EXPECT_EQ(commissioning.phase, COMMISSIONING_MAP) << "which is passed over";
}

// Within the speeds that are allowed, and no faster than the drive's own ramp.
TEST_F(Phases, TheSpinStaysWithinTheSpeedLimit) {
  parameters.spin_speed = 900 * 256;
  parameters.speed_limit = 450 * 256;
  use_parameters();
  inside::is_exclusive() = true;
  std::int32_t most = 0;
  (void)step(commissioning_spin);
  for (int n = 0; n < 80000 && (n == 0 || inside::spins()); ++n) {
    (void)step(commissioning_spin);
    inside::ramped_bpp() = inside::selected().speed_bpp = inside::target_bpp();
    inside::selected().angle_bam += static_cast<std::uint32_t>(inside::target_bpp());
    most = std::max(most, inside::target_bpp());
  }
  EXPECT_NEAR(most, bpp_of(450), 300);
  SetUp();
  for (int n = 0; n < 20000; ++n) (void)step(commissioning_spin);  // the ramp does not move
  EXPECT_EQ(commissioning.spin.leg, 0);
  EXPECT_EQ(commissioning.spin.tick, 0);
}

}  // namespace

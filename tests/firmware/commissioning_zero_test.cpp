// The staircase of a machine whose L/R leaves alternating pulses no room: levels under the zero vector alone.

#include "tests/firmware/commissioning_phases.hpp"
#include "tests/firmware/commissioning_sums.hpp"

namespace {

using namespace stillspin::test;

class CommissioningAtZero : public Phases {
 protected:
  void SetUp() override {
    Phases::SetUp();
    inside::config().values.trip_current = raw(100.0, 20);  // far beyond a ripple of 17 A
    inside::config().values.current_limit = raw(80.0, 20);
  }
  /// A rotor that follows the current, with an L/R of so many periods.
  void begin(double periods, bool uniform = true) {
    machine_model_t& m = commissioning.model;
    m.yd_q30 = raw(0.2, 30);  // 20 V change the current by 4 A in a period
    m.rs_q24 = raw(1.0 / periods / real(m.yd_q30, 30), 24);
    commissioning.uniform = uniform;
    commissioning.tick = 0;
    (void)commissioning_climb(&drive);
    commissioning.tick = 1;
  }
  static staircase_t& stairs() { return commissioning.staircase; }
  static double level(int index) { return real(stairs().first_q20 + stairs().step_q20 * index, 20); }
};

// Of U/4 R, 2.4 times the ripple of 2/3 U/L leave an eighth for the line where L/R is above 7.3 periods; where they do
// not, the pulses are gone, and with them what the levels had to keep off.
TEST_F(CommissioningAtZero, AShortTimeConstantHasNoPulses) {
  const std::int16_t pulse = inside::config().modulator.pulse_ticks;
  for (const double periods : {8.0, 7.4, 7.2, 2.0}) {
    commissioning.sampling = SAMPLING_LONGER;
    begin(periods);
    (void)step(commissioning_climb);
    const double most = kLink / 4.0 * pulse / 1e4 * periods * 0.2;
    const double ripple = 2.4 * 8.0 / 3.0 / periods;  // of the largest current
    const bool zero = ripple > 0.875;
    EXPECT_EQ(stairs().at_zero, zero) << periods;
    EXPECT_EQ(inside::reload_requested(), zero) << periods;
    drive_config_t made = inside::config();
    made.modulator.extended.window_max_ticks = 3000;
    EXPECT_EQ(commissioning_part.make(&made), PACKED_NONE);
    EXPECT_EQ(made.modulator.pulse_ticks, zero ? 0 : pulse) << periods;
    EXPECT_EQ(made.modulator.extended.window_max_ticks, zero ? 0 : 3000) << periods;
    EXPECT_EQ(inside::config().modulator.pulse_ticks, pulse) << "the exchange alone changes what is in use";
    inside::withdraw_reload();
    EXPECT_NEAR(level(13), most, 0.01 * most) << periods;
    EXPECT_NEAR(level(0), (zero ? 0.4 : ripple) * most, 0.01 * most) << periods;
  }
}

// What shows an axis is held by windows under active vectors, and keeps its pulses.
TEST_F(CommissioningAtZero, ARotorThatIsHeldKeepsItsPulses) {
  const std::int16_t pulse = inside::config().modulator.pulse_ticks;
  begin(2.0, false);
  EXPECT_FALSE(stairs().at_zero);
  EXPECT_EQ(inside::config().modulator.pulse_ticks, pulse);
  EXPECT_EQ(level(13), 0.0);
}

// The last window is the zero vector's, with an active one before it or without: its own current and what it leaves
// over. A period without samples adds nothing.
TEST_F(CommissioningAtZero, TheSumsAreOfTheZeroVector) {
  for (const int count : {0, 1, 2}) {
    SetUp();
    begin(2.0);
    ASSERT_TRUE(stairs().at_zero);
    stairs().level[0] = {};
    windows({3.0, 0.0}, 0.05, -0.01);
    const int last = count == 2 ? 1 : 0;
    for (int k = 0; k < 2; ++k) inside::frames()[k].current_q18 = {raw(k == last ? 3.0 : 9.0, 18), 0};
    const deviation_t seen = commissioning_window(&drive, static_cast<std::uint16_t>(last));
    inside::window_count() = static_cast<std::uint16_t>(count);
    inside::current_dq_q20() = {raw(2.0, 20), 0};  // at the period's end
    stairs().turn = 17;
    stairs().tick = 601;
    for (int n = 0; n < 18; ++n) (void)step(commissioning_climb);
    const staircase_level_t& l = stairs().level[0];
    EXPECT_EQ(l.periods, count == 0 ? 0 : 6) << count;
    EXPECT_EQ(l.windows, count == 0 ? 0 : 12) << count;
    EXPECT_EQ(l.current, l.periods * raw(3.0, 20)) << count;
    EXPECT_EQ(l.residual, l.windows * std::int64_t{seen.residual_q20.d}) << count;
    EXPECT_EQ(l.sag, 0) << count;
  }
}

// Behind the last level, without current, the pulses come back: the inductances want pairs. It is asked for until they
// are there: who made the configuration meanwhile may have taken the request back.
TEST_F(CommissioningAtZero, ThePulsesComeBack) {
  for (const double periods : {2.0, 20.0}) {
    SetUp();
    begin(periods);
    ASSERT_EQ(stairs().at_zero, periods < 16.0 / 3.0);
    inside::withdraw_reload();
    const std::int16_t pulse = inside::config().modulator.pulse_ticks;
    if (stairs().at_zero) inside::config().modulator.pulse_ticks = 0;
    stairs().index = STAIRCASE_LEVELS;
    stairs().tick = 0;
    inside::reference_dq_q20() = {inside::config().values.current_limit / 64 + 1, 0};
    (void)step(commissioning_climb);
    EXPECT_FALSE(inside::reload_requested()) << "while a current flows";
    for (int n = 0; n < 2; ++n) {
      (void)step(commissioning_climb);
      EXPECT_EQ(inside::reload_requested(), stairs().at_zero) << n;
      inside::withdraw_reload();
    }
    EXPECT_EQ(stairs().tick == 0, stairs().at_zero);
    inside::config().modulator.pulse_ticks = pulse;
    for (int n = 0; n < 9; ++n) (void)step(commissioning_climb);
    EXPECT_FALSE(inside::reload_requested()) << "they are there";
    EXPECT_GE(stairs().tick, 9);
  }
}

// The command sees the current at the period's end, where the ripple is lowest, and with it a resistance that is too
// large; the windows their own. What both have alike at no current is the edges'.
TEST(CommissioningZeroVector, TheResistanceIsTheWindows) {
  const machine_model_t m = nameplate();
  staircase_t s = climbed(m, 0.387, 0.08, -0.15);
  for (staircase_level_t& l : s.level) l.command += 4200LL * raw(0.06 * real(l.current / 4200, 20), 20);
  s.at_zero = true;
  staircase_values_t v = staircase_solve(&s, &m);
  ASSERT_TRUE(v.valid);
  EXPECT_NEAR(real(v.resistance_q24, 24), 0.387, 1e-4);
  EXPECT_NEAR(real(v.drop_error_q16, 16), 0.08, 1e-3);
  EXPECT_NEAR(real(v.edge_error_q16, 16), -0.15, 1e-3);
  EXPECT_LT(real(v.window_rms_q16, 16), 1e-3);
  s.at_zero = false;
  v = staircase_solve(&s, &m);
  EXPECT_GT(real(v.resistance_q24, 24), 0.44) << "with pairs of windows the command is the better one";
}

}  // namespace

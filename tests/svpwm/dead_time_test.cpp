// Dead-time compensation against a leg in double precision: two devices with delays, two diodes, a dead band.

#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/dead_time.h"
#include "svpwm/edges.h"
#include "svpwm/ripple.h"
}

namespace {

using namespace stillspin::test;

constexpr double kDeadTicks = 200.0, kTurnOn = 30.0, kTurnOff = 60.0;
constexpr double kLink = 300.0;

dead_time_config_t config() {
  dead_time_config_t c = {};
  c.turn_on_ticks = static_cast<std::int16_t>(kDeadTicks + kTurnOn);
  c.turn_off_ticks = static_cast<std::int16_t>(kTurnOff);
  c.edge_band_q20 = raw(0.7, 20);
  c.band_q20 = raw(0.2, 20);
  c.drop_q16 = raw(0.95, 16);
  dead_time_design(&c);
  return c;
}

/// When the leg's voltage really changes. The commanded edge switches one device off at once and the other on after the
/// dead band; each follows after its own delay. A current out of the leg (i > 0) is carried by the lower diode whenever
/// the upper device is off, a current into it by the upper diode whenever the lower device is off.
double edge_at_motor(double command, bool rising, double current) {
  const double off = command + kTurnOff;
  const double on = command + kDeadTicks + kTurnOn;
  if (rising) return (current > 0.0) ? on : off;  // the upper device must turn on, or the lower one lets go
  return (current > 0.0) ? off : on;
}

double phase(Vector i, int leg) { return legs_of(i)[static_cast<std::size_t>(leg)]; }

svpwm_pulses_t some_pulses(Random& random) {
  modulator_config_t c = default_modulator();
  modulator_t s;
  modulator_reset(&s);
  svpwm_pulses_t p;
  modulator_step(&s, &c, static_cast<excitation_t>(random.below(3)),
                 raw_ab(random.direction(random.between(0.0, 90.0)), 16), raw(kLink, 16), &p);
  return p;
}

TEST(DeadTime, TheMotorSeesTheWantedEdges) {
  Random random(120);
  const Motor motor;
  const dead_time_config_t c = config();
  const double y = 0.5 * kPeriod * (1.0 / motor.ld + 1.0 / motor.lq);
  int positive = 0, negative = 0;
  for (int n = 0; n < 4000; ++n) {
    const svpwm_pulses_t wanted = some_pulses(random);
    const Vector mean = random.direction(random.between(0.0, 12.0));
    const svpwm_pulses_t command =
        sent(c, wanted, {dead_time_shares_q12(&c, raw_ab(mean, 20)), raw(y, 30), raw(kLink, 16)}).command;
    for (int leg = 0; leg < 3; ++leg) {
      for (const bool rising : {true, false}) {
        const std::int16_t edge = wanted.at[rising ? leg : SVPWM_LEGS + leg];
        const std::int16_t at = command.at[rising ? leg : SVPWM_LEGS + leg];
        // what counts is the current at the edge: mean and ripple
        const Vector flux = real(svpwm_ripple_q16(&wanted, &edge, 1, raw(kLink, 16)), 16);
        const double current = phase(mean + flux * y, leg);
        ASSERT_GE(at, 1);
        ASSERT_LE(at, 9999);
        if (std::fabs(current) < 0.202) {
          // inside the band the shift is between the two
          ASSERT_GE(edge - at, kTurnOff - 1);
          ASSERT_LE(edge - at, kDeadTicks + kTurnOn + 1);
          continue;
        }
        (current > 0.0 ? positive : negative)++;
        ASSERT_NEAR(edge_at_motor(at, rising, current), edge, 1.0) << current << ", leg " << leg << rising;
      }
    }
  }
  EXPECT_GT(positive, 3000);
  EXPECT_GT(negative, 3000);
}

TEST(DeadTime, InTheBandTheShiftIsLinear) {
  const dead_time_config_t c = config();
  const svpwm_pulses_t wanted = ordered({{2000, 2000, 2000, 7000, 7000, 7000}, 0});  // 000 and 111: no ripple
  for (double i = -0.2; i <= 0.2; i += 0.02) {
    const svpwm_pulses_t command =
        sent(c, wanted, {dead_time_shares_q12(&c, raw_ab({i, 0.0}, 20)), raw(0.016, 30), raw(kLink, 16)}).command;
    const double middle = 0.5 * (kDeadTicks + kTurnOn + kTurnOff);
    const double half = 0.5 * (kDeadTicks + kTurnOn - kTurnOff);
    EXPECT_NEAR(wanted.at[0] - command.at[0], middle + half * i / 0.2, 0.51) << i;
    EXPECT_NEAR(wanted.at[3] - command.at[3], middle - half * i / 0.2, 0.51) << i;
  }
}

TEST(DeadTime, DropOpposesEachPhaseCurrent) {
  Random random(121);
  const dead_time_config_t c = config();
  for (int n = 0; n < 3000; ++n) {
    const Vector i = random.direction(random.between(0.0, 10.0));
    const auto phases = legs_of(i);
    double drop[3];
    for (std::size_t k = 0; k < 3; ++k) drop[k] = 0.95 * std::max(-1.0, std::min(1.0, phases[k] / 0.2));
    const Vector expected = {(2.0 * drop[0] - drop[1] - drop[2]) / 3.0, (drop[1] - drop[2]) / std::sqrt(3.0)};
    const Vector got = real(dead_time_drop_q16(&c, raw_ab(i, 20)), 16);
    // Shares of the band have 12 bits, are rounded down and reach 4095 / 4096: 4/3 and 2/sqrt(3) of that of 0.95 V.
    ASSERT_NEAR(got.x, expected.x, 3.2e-4);
    ASSERT_NEAR(got.y, expected.y, 2.9e-4);
  }
}

// The same from pulses: every edge that no other presses is shifted along the line.
TEST(DeadTime, InAWideBandEveryEdgeIsShiftedByItsCurrent) {
  Random random(121);
  dead_time_config_t c = config();
  c.band_q20 = raw(1.5, 20);
  c.edge_band_q20 = raw(2.0, 20);
  dead_time_design(&c);
  const double middle = 0.5 * (kDeadTicks + kTurnOn + kTurnOff), half = 0.5 * (kDeadTicks + kTurnOn - kTurnOff);
  const sampling_config_t sampling = default_modulator().sampling;
  int between = 0;
  for (int n = 0; n < 500; ++n) {
    svpwm_pattern_t pattern = {};
    pattern.pulses = some_pulses(random);
    const Vector mean = random.direction(random.between(0.0, 3.0));
    // no ripple: the current of an edge is its leg's mean
    const svpwm_carried_t carried = {dead_time_shares_q12(&c, raw_ab(mean, 20)), 0, raw(kLink, 16)};
    const svpwm_pulses_t command = send(c, sampling, carried, &pattern);
    for (std::uint16_t edge = 0; edge < SVPWM_EDGES; ++edge) {
      const double blocking = (edge < SVPWM_LEGS ? 1.0 : -1.0) * phase(mean, edge % SVPWM_LEGS);
      const double share = std::clamp(blocking / 1.5, -1.0, 1.0);
      ASSERT_NEAR(pattern.pulses.at[edge] - command.at[edge], middle + half * share, 1.0) << blocking;
      between += std::fabs(blocking) < 1.5 ? 1 : 0;
    }
  }
  EXPECT_GT(between, 300);
}

// A current beyond the error of its prediction is certain: its edge comes when it is wanted.
TEST(DeadTime, AboveItsErrorACurrentIsCertain) {
  const dead_time_config_t c = config();
  for (const double amps : {0.69, 0.71, -0.69, -0.71}) {
    const auto share_q12 = static_cast<std::int32_t>(std::lround(amps / 0.2 * 4096.0));
    EXPECT_EQ(dead_time_is_in_doubt(&c, share_q12), std::fabs(amps) < 0.7) << amps;
    EXPECT_EQ(dead_time_delay_ticks(&c, share_q12), amps > 0.0 ? kDeadTicks + kTurnOn : kTurnOff);
  }
}

// At the error itself it is certain already, in both directions; the last current in doubt is one step of 2^-12 bands
// below it.
TEST(DeadTime, DoubtEndsJustBelowTheError) {
  dead_time_config_t c = config();
  c.band_q20 = raw(0.25, 20);
  c.edge_band_q20 = raw(0.75, 20);
  dead_time_design(&c);
  const std::int32_t end_q12 = 3 * 4096;
  for (const int sign : {1, -1}) {
    EXPECT_TRUE(dead_time_is_in_doubt(&c, 0));
    EXPECT_TRUE(dead_time_is_in_doubt(&c, sign * (end_q12 - 1)));
    EXPECT_FALSE(dead_time_is_in_doubt(&c, sign * end_q12));
    EXPECT_FALSE(dead_time_is_in_doubt(&c, sign * (end_q12 + 1)));
    EXPECT_FALSE(dead_time_is_in_doubt(&c, sign > 0 ? INT32_MAX : INT32_MIN));
  }
}

}  // namespace

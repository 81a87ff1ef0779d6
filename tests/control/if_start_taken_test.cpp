// The I-F start's vector takes over a rotor that turns: how it leads it over, through standstill, and when it gives up.

#include "tests/control/if_start_shaft.hpp"

namespace stillspin::test {
namespace {

// A rotor that turns is taken over under its load, and turned the other way: it never leaves the vector by more than a
// fifth of its speed at the end, down to standstill and through.
TEST(IfStart, TakesATurningRotorThroughStandstill) {
  const if_start_config_t c = designed(motor_b(), usual());
  for (const double pull : {-3.0, -1.0, 0.0, 1.0, 3.0}) {
    for (const bool forward : {false, true}) {
      Shaft shaft;
      shaft.speed = forward ? 120.0 : -120.0;
      shaft.angle = 0.4;
      shaft.pull = pull;
      if_start_t s = {};
      const double ahead = std::asin(pull / (shaft.m.torque_constant() * 8.0));
      if_start_begin_turning(&s, &c, bam(0.4 + ahead), raw(8.0, 20), bpp(shaft.speed));
      s.end_bpp = forward ? -c.speed_bpp : c.speed_bpp;
      Vector voltage = shaft.step(rad(s.angle_bam), 8.0);
      double off = 0.0;
      if_start_result_t result = IF_START_PENDING;
      for (int n = 0; result == IF_START_PENDING && n < 40000; ++n) {
        if (n % 10 == 0) if_start_renew(&s, &c, raw_dq(voltage, 16));
        result = if_start_step(&s, &c, raw_dq(voltage, 16), bam(shaft.angle), bpp(shaft.speed));
        voltage = shaft.step(rad(s.angle_bam), real(s.current_q20, 20));
        off = std::max(off, std::fabs(shaft.speed - rad_per_s(s.speed_bpp)));
      }
      EXPECT_EQ(result, IF_START_TAKEN_OVER) << pull;
      EXPECT_LT(off, 25.0) << pull;
      EXPECT_NEAR(shaft.speed, forward ? -125.7 : 125.7, 2.5) << pull;
    }
  }
}

// A vector whose own flux is half of the magnet's holds a rotor, too, that two thirds of its rated torque let swing:
// what the vector takes by itself is no EMF.
TEST(IfStart, ALongVectorLetsNoRotorSwingAway) {
  Shaft shaft;
  shaft.m.rs = 0.268;
  shaft.m.ld = shaft.m.lq = 2.2e-3;
  shaft.m.flux = 0.12258;
  shaft.m.inertia = 0.0146;
  if_start_config_t given = usual();
  given.current_q20 = raw(19.6, 20);
  given.speed_bpp = bpp(440.0);
  const if_start_config_t c = designed(shaft.m, given);
  for (const auto& [way, off] : {std::pair{1.0, 0.0}, {1.0, 0.2}, {1.0, -0.2}, {-1.0, 0.2}, {-1.0, -0.2}}) {
    shaft.speed = way * 440.0;
    shaft.angle = 0.0;
    shaft.pull = way * 9.65;
    const double ahead = std::asin(shaft.pull / (shaft.m.torque_constant() * 30.0)) + off;
    if_start_t s = {};
    if_start_begin_turning(&s, &c, bam(ahead), raw(30.0, 20), bpp(shaft.speed));
    Vector voltage = shaft.step(rad(s.angle_bam), 30.0);
    for (int n = 0; n < 20000; ++n) {
      if (n % 10 == 9) if_start_renew(&s, &c, raw_dq(voltage, 16));
      const double opposite = shaft.angle + kPi;
      ASSERT_EQ(if_start_step(&s, &c, raw_dq(voltage, 16), bam(opposite), bpp(shaft.speed)), IF_START_PENDING);
      voltage = shaft.step(rad(s.angle_bam), 30.0);
      ASSERT_LT(std::fabs(wrapped(rad(s.vector_bam) - shaft.angle)), 1.3) << off << ", " << n;
    }
    EXPECT_NEAR(shaft.speed, way * 440.0, 4.4) << off;
  }
}

// What it takes over is known when its current has settled: neither the EMF that the load turns nor a current on its
// way is taken for a speed. The vector stays where it was put for 4 ms, however fast it is and whoever agrees with it,
// and within a quarter of what it may turn behind that.
TEST(IfStart, ATakenRotorIsNotThrown) {
  const if_start_config_t c = designed(motor_b(), usual());
  for (const double ahead : {-0.5, 0.0, 0.5}) {
    for (const double speed : {-140.0, -120.0, 120.0, 126.0, 140.0}) {
      for (const bool agrees : {false, true}) {
        Shaft shaft;
        shaft.speed = speed;
        shaft.pull = shaft.m.torque_constant() * 8.0 * std::sin(ahead);
        if_start_t s = {};
        if_start_begin_turning(&s, &c, bam(ahead), raw(8.0, 20), bpp(speed));
        if_start_turn_to(&s, &c, speed > 0.0 ? c.speed_bpp : -c.speed_bpp);
        for (int n = 0; n < 70; ++n) {
          const Vector voltage = shaft.step(rad(s.angle_bam), 8.0) + (n < 12 ? Vector{-30.0, 20.0} : Vector{0.0, 0.0});
          if (n % 10 == 9) if_start_renew(&s, &c, raw_dq(voltage, 16));
          const double seen = agrees ? shaft.angle : shaft.angle + kPi;
          (void)if_start_step(&s, &c, raw_dq(voltage, 16), bam(seen), bpp(shaft.speed));
          const double beside = wrapped(rad(s.angle_bam) - rad(s.vector_bam));
          EXPECT_NEAR(beside, 0.0, n < 40 ? 0.0 : 0.2) << ahead << " " << speed << " " << n;
        }
      }
    }
  }
}

// One that a load pulls away is left alone with it 50 ms after its EMF is too large for the vector's.
TEST(IfStart, ARotorThatRunsAwayIsGivenUp) {
  const if_start_config_t c = designed(motor_b(), usual());
  Shaft shaft;
  shaft.speed = 120.0;
  shaft.pull = 6.0;  // the vector bears 4.1
  if_start_t s = {};
  if_start_begin_turning(&s, &c, bam(1.5), raw(8.0, 20), bpp(120.0));
  s.end_bpp = 0;
  Vector voltage = shaft.step(rad(s.angle_bam), 8.0);
  int away = -1, n = 0;
  while (n < 20000 && if_start_step(&s, &c, raw_dq(voltage, 16), 0, 0) == IF_START_PENDING) {
    if (n++ % 10 == 0) if_start_renew(&s, &c, raw_dq(voltage, 16));
    voltage = shaft.step(rad(s.angle_bam), real(s.current_q20, 20));
    if (away < 0 && std::fabs(shaft.speed) > 3.0 * 125.7) away = n;
  }
  ASSERT_GT(away, 0);
  EXPECT_NEAR(n - away, 500, 250) << "by the largest of two components, which a turning EMF fills in turn";
}

}  // namespace
}  // namespace stillspin::test

// The d-axis current of the speed task, field weakening and its other reasons, and what the torque has beside it.

#include <algorithm>
#include <cmath>

#include "tests/firmware/speed_control.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
#include "firmware/sources/flux/flux.h"
}

namespace {

using namespace stillspin::test;

// The voltage that the modulator has, by as much of it as may be used: link / sqrt(3).
TEST_F(SpeedTask, WeakeningSeesWhatTheModulatorHas) {
  parameters.voltage_use = raw(92.0, 16);
  parameters.weakening_limit = raw(7.0, 20);
  parameters.weakening_gain = 1234;
  use_parameters();
  inside::command_dq_q16() = {raw(-60.0, 16), raw(80.0, 16)};
  inside::reference_dq_q20().q = raw(3.0, 20);
  for (const double w : {500.0, 1200.0, 1400.0, 3000.0}) {
    speed(w);
    inside::field_weakening() = {raw(-1.0, 20), 0};
    part(TASK_FIELD);
    const field_weakening_input_t in = {
        bpp(w), raw(3.0, 20), raw(100.0, 16), raw(kLink / std::sqrt(3.0) * 0.92, 16), raw(7.0, 20), 1234};
    field_weakening_t expected = {raw(-1.0, 20), 0};
    field_weakening_step(&expected, &in, &inside::model());
    EXPECT_NEAR(real(inside::weakening_q20(), 20), real(expected.id_q20, 20), 1e-3) << w;
    EXPECT_NEAR(real(inside::field_weakening().trim_q20, 20), real(expected.trim_q20, 20), 1e-4) << w;
  }
}

// A start weakens the field of the shaft that it has caught itself (start_caught_frame_test.cpp).
TEST_F(SpeedTask, WeakeningIsForAShaftThatTurns) {
  const auto sees = [&](drive_state_t state) {
    inside::be_in(state);
    inside::is_caught() = state == DRIVE_START;
    constexpr std::int32_t kMark = 77;
    inside::weakening_q20() = kMark;
    part(TASK_FIELD);
    return inside::weakening_q20() != kMark;
  };
  EXPECT_TRUE(sees(DRIVE_RUN));
  EXPECT_TRUE(sees(DRIVE_STOP));
  EXPECT_FALSE(sees(DRIVE_START));
  EXPECT_FALSE(sees(DRIVE_READY));
}

// What weakening and maximum torque per ampere ask for, whichever is more, and what is wanted at low speed on top,
// where the observer is in use there; but weakening none of it in a commissioning, which has what its spin asks for.
TEST_F(SpeedTask, TheFieldCurrentIsTheLeastOfItsReasons) {
  parameters.id_low_speed = raw(1.5, 20);
  use_parameters();
  inside::spin_d_q20() = raw(0.75, 20);
  inside::reference_dq_q20().q = raw(9.0, 20);
  const double best = real(mtpa_current_q20(&inside::config().mtpa, raw(9.0, 20)), 20);
  ASSERT_LT(best, -0.3);
  struct Case {
    double weakening;
    std::int32_t mtpa;
    blend_region_t region;
    drive_state_t state;
    double expected;
  };
  const Case cases[] = {{0.0, 0, BLEND_LOW, DRIVE_RUN, 1.5},
                        {-4.0, 0, BLEND_LOW, DRIVE_RUN, -2.5},
                        {0.0, 1, BLEND_LOW, DRIVE_RUN, best + 1.5},
                        {-4.0, 1, BLEND_BOTH, DRIVE_RUN, -2.5},
                        {best / 2, 1, BLEND_LOW, DRIVE_RUN, best + 1.5},
                        {-4.0, 1, BLEND_HIGH, DRIVE_RUN, -4.0},
                        {0.0, 1, BLEND_HIGH, DRIVE_RUN, best},
                        {0.0, 1, BLEND_LOW, DRIVE_COMMISSION, 0.75},
                        {-4.0, 1, BLEND_HIGH, DRIVE_COMMISSION, -3.25},
                        {-20.0, 0, BLEND_LOW, DRIVE_RUN, -10.0}};
  for (const Case& c : cases) {
    parameters.mtpa = c.mtpa;
    use_parameters();
    inside::be_in(c.state);
    inside::spins() = true;
    inside::blend_region() = c.region;
    inside::weakening_q20() = raw(c.weakening, 20);
    inside::reference_dq_q20().q = raw(9.0, 20);
    inside::limits() = c.weakening < 0.0 ? 0 : LIMIT_WEAKENING;
    part(TASK_SPEED);
    EXPECT_NEAR(id(), c.expected, 1e-4) << c.weakening << ", " << c.mtpa << ", " << c.region;
    EXPECT_EQ((inside::limits() & LIMIT_WEAKENING) != 0, c.weakening < 0.0);
  }
}

// Without torque the flux would be blind: three times the current whose sign is certain flows, less what torque makes
// flow, at low speed and where the flux has the shaft.
TEST_F(SpeedTask, SomeCurrentFlowsWhereTheFluxSees) {
  NEEDS("sources/flux");
  struct Case {
    double iq, speed, limit;
    std::int16_t share_q15;
    std::int32_t source;
    double expected;
  };
  const Case cases[] = {
      {0.0, 10.0, 10.0, 0, 7, -2.1},   {-1.5, -10.0, 10.0, 0, 5, -0.6},      {3.0, 10.0, 10.0, 0, 7, 0.0},
      {0.0, -399.0, 10.0, 0, 7, -2.1}, {0.0, -401.0, 10.0, 0, 7, 0.0},       {0.0, 10.0, 3.0, 0, 7, -1.5},
      {0.0, 10.0, 10.0, 1, 7, 0.0},    {0.0, 10.0, 10.0, INT16_MAX, 7, 0.0}, {0.0, 10.0, 10.0, 0, 4, 0.0}};
  inside::config().dead_time.edge_band_q20 = raw(0.7, 20);
  flux_config.adaptation.lowest_bpp = bpp(400.0);
  parameters.mtpa = 0;
  use_parameters();
  for (const Case& c : cases) {
    use_source(c.source);
    inside::current_limit_q20() = raw(c.limit, 20);
    flux_observability_q20 = 0;
    inside::blend_share_q15() = c.share_q15;
    speed(c.speed);
    for (int n = 0; n < 200; ++n) {
      inside::reference_dq_q20().q = raw(c.iq, 20);
      part(TASK_SPEED);
      if (n == 0) {
        EXPECT_NEAR(id(), c.expected / 16.0, 1e-3) << c.iq << ", " << c.speed;
      }
    }
    EXPECT_NEAR(id(), c.expected, 1e-3) << c.iq << ", " << c.speed << ", " << c.share_q15 << ", " << c.source;
  }
}

// What the largest current leaves beside i_d.
TEST_F(SpeedTask, TheTorqueCurrentHasTheRest) {
  for (const auto& [d, room] : {std::pair{0.0, 10.0}, {-6.0, 8.0}, {6.0, 8.0}, {-10.0, 0.0}, {-11.0, 0.0}}) {
    inside::reference_dq_q20().d = raw(d, 20);
    EXPECT_NEAR(real(drive_current_headroom(&drive), 20), room, 1e-5) << d;
    inside::weakening_q20() = raw(std::min(d, 0.0), 20);
    parameters.id_low_speed = raw(std::max(d, 0.0), 20);
    parameters.mtpa = 0;
    use_parameters();
    part(TASK_SPEED);
    EXPECT_NEAR(real(inside::headroom_q20(), 20), room, 1e-5) << d;
  }
}

// Up to the EMF that tells the angle as well as an eighth of the saliency, a sixth of its share of the link, the
// current is that which leaves the saliency; at twice that it is the whole limit's again.
TEST_F(SpeedTask, ARotorThatIsFoundByItsSaliencyKeepsIt) {
  const double l_d = real(parameters.inductance_d, 20), l_q = real(parameters.inductance_q, 20);
  const double even = kLink / 6.0 * (l_q - l_d) / (l_q + l_d) / real(parameters.magnet_flux, 28);  // rad/s
  const auto room = [&](double salient, double speed_then, int source) {
    parameters.saliency_current = raw(salient, 20);
    parameters.position_source = source;
    EXPECT_TRUE(drive_config_load(&inside::config()));
    inside::current_limit_q20() = raw(10.0, 20);
    use_source(source);
    speed(speed_then);
    return real(drive_current_headroom(&drive), 20);
  };
  EXPECT_NEAR(room(0.0, 0.0, POSITION_OBSERVER), 10.0, 1e-5);
  EXPECT_NEAR(room(12.0, 0.0, POSITION_OBSERVER), 10.0, 1e-5);
  EXPECT_NEAR(room(6.0, 0.0, POSITION_OBSERVER), 6.0, 1e-5);
  EXPECT_NEAR(room(6.0, -0.99 * even, POSITION_OBSERVER), 6.0, 1e-5);
  EXPECT_NEAR(room(6.0, 1.5 * even, POSITION_OBSERVER), 8.0, 0.02);
  EXPECT_NEAR(room(6.0, -1.25 * even, POSITION_OBSERVER), 7.0, 0.02);
  EXPECT_NEAR(room(6.0, 2.01 * even, POSITION_OBSERVER), 10.0, 1e-5);
  EXPECT_NEAR(room(6.0, 0.0, POSITION_OBSERVER), 6.0, 1e-5);
  inside::ramped_bpp() = inside::target_bpp() = bpp(500.0);
  inside::current_limit_q20() = raw(10.0, 20);
  for (int n = 0; n < 5; ++n) part(TASK_SPEED);
  EXPECT_NEAR(iq(), 6.0, 1e-4);
  EXPECT_NE(inside::limits() & LIMIT_CURRENT, 0);
}

// Where the map ends with the saliency, and a fall of Lqq that goes on turns its sign at the limit, the current is all
// there at twice the EMF that balances it; an Lqq that rises turns nothing.
TEST_F(SpeedTask, ASaliencyThatTurnsItsSignIsOutweighedFirst) {
  const double l_d = real(parameters.inductance_d, 20), l_q = real(parameters.inductance_q, 20);
  const double flux = real(parameters.magnet_flux, 28);
  const double even = kLink / 6.0 * (l_q - l_d) / (l_q + l_d) / flux;  // rad/s
  for (const double last : {1.5, 0.9, 0.8, 0.7}) {
    const std::int32_t fall = raw(100.0 * (1.0 - last) / 4.0, 16), whole = raw(100.0, 16);
    parameters.lqq_1 = whole - fall;
    parameters.lqq_2 = whole - 2 * fall;
    parameters.lqq_3 = whole - 3 * fall;
    parameters.lqq_4 = whole - 4 * fall;
    parameters.map_current = parameters.saliency_current = raw(6.0, 20);
    parameters.current_limit = raw(12.0, 20);
    ASSERT_TRUE(drive_config_load(&inside::config()));
    inside::current_limit_q20() = raw(12.0, 20);
    const double beyond = l_q / (1.0 + std::max(1.0 / last - 1.0, 0.0) * 4.0);
    const double above = last * l_q / l_d - 1.0, below = std::max(0.0, 1.0 - beyond / l_d);
    const double freed = std::max(2.0 * even, 4.0 / 3.0 * kLink * std::sqrt(above * below) / flux);
    EXPECT_EQ(freed > 2.0 * even, last < 0.9) << "else this shows nothing";
    for (const auto& [at, room] : {std::pair{0.99 * even, 6.0},
                                   {-(0.75 * even + 0.25 * freed), 7.5},
                                   {0.5 * even + 0.5 * freed, 9.0},
                                   {1.01 * freed, 12.0}}) {
      speed(at);
      EXPECT_NEAR(real(drive_current_headroom(&drive), 20), room, 0.02) << last << " at " << at;
    }
  }
}

// A measured angle needs no saliency.
TEST_F(SpeedTask, AnEncoderBearsAnyCurrent) {
  NEEDS("sources/encoder");
  parameters.saliency_current = raw(6.0, 20);
  parameters.position_source = POSITION_ENCODER;
  ASSERT_TRUE(drive_config_load(&inside::config()));
  inside::current_limit_q20() = raw(10.0, 20);
  use_source(POSITION_ENCODER);
  EXPECT_NEAR(real(drive_current_headroom(&drive), 20), 10.0, 1e-5);
}

}  // namespace

// From the users' units to the modules': every parameter, away from its default, arrives as what it says.

#include "tests/firmware/drive_config_units.hpp"

namespace {

using namespace stillspin::test;

// L of every point of the map, as its inverse and as the flux between the points.
TEST_F(Units, TheMapIsTheMachinesAtEveryPoint) {
  const double ldd[] = {4.9, 4.9 * 0.97, 4.9 * 0.93, 4.9 * 0.88, 4.9 * 0.82};
  const double lqq[] = {7.8, 7.8 * 1.02, 7.8 * 0.95, 7.8 * 0.85, 7.8 * 0.75};
  const double ldq[] = {0.0, 0.05, -0.11, 0.17, -0.23};
  parameters.ldd_1 = raw(97, 16), parameters.ldd_2 = raw(93, 16), parameters.ldd_3 = raw(88, 16);
  parameters.ldd_4 = raw(82, 16);
  parameters.lqq_1 = raw(102, 16), parameters.lqq_2 = raw(95, 16), parameters.lqq_3 = raw(85, 16);
  parameters.lqq_4 = raw(75, 16);
  parameters.ldq_1 = raw(0.05, 20), parameters.ldq_2 = raw(-0.11, 20), parameters.ldq_3 = raw(0.17, 20);
  parameters.ldq_4 = raw(-0.23, 20);
  parameters.map_current = raw(12.0, 20);
  machine_model_t m = made().nameplate;
  EXPECT_EQ(m.iq_q20, 0) << "it begins without current";
  for (int k = 0; k < 5; ++k) {
    if (k > 0) machine_model_move(&m, raw(3.0 * k, 20));
    const double determinant = (ldd[k] * lqq[k] - ldq[k] * ldq[k]) * 1e-3;
    expect_near_share(real(m.yd_q30, 30), kPeriod * lqq[k] / determinant, 1e-4);
    expect_near_share(real(m.yq_q30, 30), kPeriod * ldd[k] / determinant, 1e-4);
    EXPECT_NEAR(real(m.ydq_q30, 30), -kPeriod * ldq[k] / determinant, 1e-6);
  }
}

// The reluctance's torque per ampere at the sensors' full scale.
TEST_F(Units, AReluctanceTooLargeForTheTorquesFormatIsRefused) {
  parameters.current_full_scale = raw(200.0, 20);
  parameters.inductance_d = raw(10.0, 20);
  parameters.inductance_q = raw(31.0, 20);  // 6 Lq - Ld 200 A = 25.2 N m/A
  EXPECT_FALSE(refused());
  parameters.inductance_q = raw(31.5, 20);  // 25.8 N m/A
  EXPECT_TRUE(refused());
}

// lambda/Lq of 1000 A at one point alone, whichever it is.
TEST_F(Units, EveryPointOfTheMapHasToFitTheFormats) {
  parameters.inductance_d = raw(0.2, 20);
  parameters.inductance_q = raw(0.8, 20);
  parameters.magnet_flux = raw(0.7, 28);
  EXPECT_FALSE(refused());
  std::int32_t parameters_t::* const points[] = {&parameters_t::lqq_1, &parameters_t::lqq_2, &parameters_t::lqq_3,
                                                 &parameters_t::lqq_4};
  for (const auto point : points) {
    parameters.*point = raw(86.0, 16);
    EXPECT_TRUE(refused());
    parameters.*point = raw(89.0, 16);
    EXPECT_FALSE(refused());
    parameters.*point = raw(100.0, 16);
  }
}

TEST_F(Units, WindowsAndEdges) {
  parameters.pulse_time = raw(41.5, 16);
  parameters.window_minimum = raw(17.5, 16);
  parameters.window_maximum = raw(29.37, 16);
  parameters.zero_time = raw(12.34, 16);
  parameters.settle_time = raw(9.87, 16);
  parameters.dead_time = raw(1.41, 16);
  parameters.turn_on_delay = raw(0.27, 16);
  parameters.turn_off_delay = raw(0.73, 16);
  parameters.drop_band = raw(0.3, 20);
  parameters.device_drop = raw(1.25, 16);
  const drive_config_t& c = made();
  EXPECT_EQ(c.modulator.pulse_ticks, 4150);
  EXPECT_EQ(c.modulator.extended.window_min_ticks, 1750);
  EXPECT_EQ(c.modulator.extended.window_max_ticks, 2937);
  EXPECT_EQ(c.modulator.extended.zero_ticks, 1234);
  EXPECT_EQ(c.modulator.sampling.settle_ticks, 987);
  EXPECT_EQ(c.modulator.sampling.burst_ticks, static_cast<int>(HAL_ADC_BURST_TICKS));
  EXPECT_EQ(c.dead_time.turn_on_ticks, 168);
  EXPECT_EQ(c.dead_time.turn_off_ticks, 73);
  EXPECT_EQ(c.dead_time.band_q20, raw(0.3, 20));
  EXPECT_NEAR(real(c.dead_time.edge_band_q20, 20), 0.8, 1e-6) << "half an ampere of the ripple on top";
  EXPECT_EQ(c.dead_time.drop_q16, raw(1.25, 16));
  const ab_t large = {raw(5.0, 20), 0};
  expect_near_share(real(dead_time_drop_q16(&c.dead_time, large).alpha, 16), 1.25 * 4.0 / 3.0, 1e-3);
}

TEST_F(Units, SpeedControl) {
  parameters.friction = raw(0.0123, 24);
  parameters.inertia = raw(0.0031, 24);
  parameters.speed_alpha = raw(345.0, 14);
  parameters.speed_trajectory = raw(9.5, 8);
  parameters.speed_pi_bandwidth = raw(33.0, 8);
  parameters.speed_pi_damping = raw(0.9, 12);
  parameters.speed_ramp = raw(1700.0, 8);
  parameters.position_hold = raw(7.5, 8);
  const drive_config_t& c = made();
  EXPECT_EQ(c.speed.friction_q24, parameters.friction);
  EXPECT_EQ(c.speed.inertia_q24, parameters.inertia);
  EXPECT_EQ(c.speed.step_periods, 10);
  EXPECT_EQ(c.speed.alpha_q8, raw(345.0, 8));
  EXPECT_EQ(c.speed.trajectory_ms_q8, parameters.speed_trajectory);
  EXPECT_EQ(c.speed.pi_bandwidth_q8, parameters.speed_pi_bandwidth);
  EXPECT_EQ(c.speed.pi_damping_q12, parameters.speed_pi_damping);
  expect_near_share(c.ramp_step_bpp, 1.7 * kBppPerRpm, 1e-4);
  expect_near_share(real(c.hold_gain_q30, 30), 7.5 * kPeriod, 1e-5);
  expect_near_share(real(c.friction_per_bpp_q40, 40), 0.0123 * kTurn / 60.0 / kBppPerRpm, 1e-3);
  mtpa_t mtpa;
  mtpa_design(&mtpa, &c.nameplate);
  EXPECT_EQ(c.mtpa.pole_q20, mtpa.pole_q20);
}

// wc^2 of the hold while a brake opens: the acceleration by the largest current, over 0.2 rad; 225 rad/s at most. Its
// observer has a fifth of the noise, more by what it is softer.
TEST_F(Units, AHeavyShaftIsHeldLessStiffly) {
  parameters.current_limit = raw(14.0, 20);
  for (const double inertia : {0.001, 0.0045, 0.02, 0.1, 0.2}) {
    parameters.inertia = raw(inertia, 24);
    const drive_config_t& c = made();
    const double accel = real(c.nameplate.torque_q24, 24) * 14.0 * parameters.pole_pairs / inertia;
    const double stiffness = std::min(225.0, std::sqrt(accel / 0.2));
    expect_near_share(real(c.release_step_q30, 30), kPeriod * stiffness, 1e-3);
    const double louder = std::min(225.0 / stiffness / 5.0, 1.0);
    expect_near_share(real(c.hold_observer.limit_q19, 19), louder * real(c.observer.limit_q19, 19), 1e-3);
  }
}

TEST_F(Units, CurrentControl) {
  for (const int divider : {1, 2}) {
    for (const int corner : {0, 1}) {
      parameters.current_bandwidth = 1500;
      parameters.current_divider = divider;
      parameters.current_corner = corner;
      const drive_config_t& c = made();
      const current_design_t design = {1500, 100, divider,
                                       corner == 1 ? CURRENT_CORNER_MACHINE : CURRENT_CORNER_HIGHER};
      current_controller_config_t wanted = {};
      current_controller_design(&wanted, &c.nameplate, &design);
      EXPECT_EQ(std::memcmp(&wanted.d, &c.current.d, sizeof wanted.d), 0) << divider << corner;
      EXPECT_EQ(std::memcmp(&wanted.q, &c.current.q, sizeof wanted.q), 0) << divider << corner;
    }
  }
}

// Variances go with the square.
TEST_F(Units, TheObserversNoiseAndLoad) {
  parameters.map_known = 1;
  const drive_config_t usual = made();
  const auto with = [](std::int32_t parameters_t::* which, double times) {
    const std::int32_t before = parameters.*which;
    parameters.*which = static_cast<std::int32_t>(std::lround(before * times));
    const drive_config_t c = made();
    parameters.*which = before;
    return c;
  };
  expect_near_share(with(&parameters_t::observer_noise, 2.0).observer.weight_q8, usual.observer.weight_q8 / 4.0, 1e-2);
  expect_near_share(with(&parameters_t::observer_load_rate, 2.0).observer.load_noise_q20,
                    usual.observer.load_noise_q20 * 4.0, 1e-2);
  expect_near_share(with(&parameters_t::observer_load_quiet, 2.0).observer.load_noise_quiet_q20,
                    usual.observer.load_noise_quiet_q20 * 4.0, 5e-2);
  expect_near_share(with(&parameters_t::observer_load_step, 0.5).observer.load_step_q20,
                    usual.observer.load_step_q20 / 4.0, 1e-2);
  expect_near_share(usual.observer.cogging.crawl_bpp, 10.0 * kBppPerRpm, 1e-4);
}

// A brake that opens lets a load fall on the shaft: a fifth of the noise, twice the load's rate, no step to look for.
TEST_F(Units, AHeldShaftsObserverIsFastAndLooksForNoStep) {
  parameters.map_known = 1;
  const drive_config_t& c = made();
  EXPECT_GT(c.observer.moving_step_q20, 0);
  expect_near_share(c.hold_observer.weight_q8, c.observer.weight_q8 / 0.04, 1e-2);
  expect_near_share(c.hold_observer.load_noise_q20, 4.0 * c.observer.load_noise_q20, 1e-2);
  EXPECT_EQ(c.hold_observer.load_noise_quiet_q20, c.hold_observer.load_noise_q20) << "at a crawl too";
  EXPECT_LT(c.hold_observer.load_step_q20, c.observer.load_step_q20 / 1000) << "the format's least";
  EXPECT_EQ(c.hold_observer.moving_step_q20, 0);
  EXPECT_EQ(c.hold_observer.cogging.crawl_bpp, c.observer.cogging.crawl_bpp);
  EXPECT_EQ(c.hold_observer.cogging.order, c.observer.cogging.order);
}

// Any number of it says that the map is known.
TEST_F(Units, WithoutTheMapNoStepIsLookedForAtSpeedAndThreeQuartersOfItAtACrawl) {
  const drive_config_t without = made();
  EXPECT_FALSE(without.mapped);
  EXPECT_EQ(without.observer.moving_step_q20, 0);
  std::int32_t parameters_t::* const which[] = {&parameters_t::map_known, &parameters_t::ldq_1, &parameters_t::ldq_2,
                                                &parameters_t::ldq_3, &parameters_t::ldq_4};
  for (const auto member : which) {
    parameters.*member = 1;
    const drive_config_t& c = made();
    EXPECT_TRUE(c.mapped);
    EXPECT_GT(c.observer.moving_step_q20, 0);
    expect_near_share(without.observer.load_step_q20, c.observer.load_step_q20 * 9.0 / 16.0, 1e-3);
    parameters.*member = 0;
  }
}

TEST_F(Units, CoggingAndWindowsOfTheObserver) {
  parameters.cogging_order = 17;
  parameters.observer_load_rate = raw(0.75, 20);
  const drive_config_t& c = made();
  EXPECT_EQ(c.observer.cogging.order, 17);
  expect_near_share(c.observer.cogging.crawl_bpp, 10.0 * kBppPerRpm, 1e-4);
  // The acceleration of the load's rate.
  const Motor m;
  expect_near_share(real(c.observer.cogging.bound_q8, 8),
                    0.75 * m.pole_pairs / m.inertia * kPeriod * kPeriod / kTurn * 4294967296.0, 1e-3);
  EXPECT_FALSE(c.observer.zero_vectors_only);
  parameters.observer_windows = 0;
  EXPECT_TRUE(made().observer.zero_vectors_only);
}

TEST_F(Units, SynchronismAndWhatIsLearnt) {
  parameters.synchronism_floor = raw(12.5, 16);
  parameters.synchronism_share = raw(45.0, 8);
  parameters.synchronism_time = 37;
  parameters.adapt_time = raw(270.0, 8);
  parameters.drift_time = raw(1300.0, 8);
  const drive_config_t& c = made();
  EXPECT_EQ(c.synchronism.floor_q16, parameters.synchronism_floor);
  EXPECT_NEAR(real(c.synchronism.share_q15, 15), 0.45, 1e-4);
  EXPECT_EQ(c.synchronism.bad_periods, 370);
  expect_near_share(real(c.adapt_share_q30, 30), SCHEDULE_SLOTS * kPeriod / 0.27, 1e-5);
  expect_near_share(real(c.drift_share_q30, 30), SCHEDULE_SLOTS * kPeriod / 1.3, 1e-5);
  parameters.adapt_time = parameters.drift_time = raw(29999.0, 8);
  EXPECT_GT(made().adapt_share_q30, 0);
  EXPECT_GT(made().drift_share_q30, 0);
  parameters.adapt_time = parameters.drift_time = raw(30000.0, 8);
  EXPECT_EQ(made().adapt_share_q30, 0) << "30000 is off";
  EXPECT_EQ(made().drift_share_q30, 0);
}

TEST_F(Units, SensorsAndTheEncoder) {
  parameters.current_full_scale = raw(33.0, 20);
  parameters.link_full_scale = raw(789.0, 16);
  parameters.sensor_mismatch = raw(-1.25, 16);
  for (const double degrees : {-180.0, -12.5, 0.01, 37.0, 180.0}) {
    parameters.encoder_trim = raw(degrees, 16);
    EXPECT_NEAR(wrapped(rad((made(), encoder.trim_bam)) - degrees * kDegree), 0.0, 1e-6) << degrees;
  }
  const drive_config_t& c = made();
  expect_near_share(real(c.slopes.amps_per_code_q30, 30), 33.0 / 2048.0, 1e-6);
  expect_near_share(real(c.codes_per_amp_q16, 16), 2048.0 / 33.0, 1e-6);
  EXPECT_EQ(c.slopes.start_samples, static_cast<int>(HAL_ADC_START_SAMPLES));
  EXPECT_EQ(c.slopes.end_samples, static_cast<int>(HAL_ADC_END_SAMPLES));
  expect_near_share(real(c.slopes.amps_per_count_q36, 36), 33.0 / 2048.0 / 12.0, 1e-5);
  EXPECT_NEAR(real(c.volts_per_code_q16, 16), 789.0 / 4096.0, 0.6 / 65536.0);
  expect_near_share(real(c.sensor_mismatch_q30, 30), -0.0125, 1e-4);
}

// dLdq/di_q is dLqq/di_d: the map's first segment, as a share of L_q per ampere.
TEST_F(Units, SaturationAlongTheAxes) {
  parameters.map_current = raw(12.0, 20);
  parameters.ldq_1 = raw(-0.09, 20);
  parameters.saturation_d = raw(-1.7, 24);
  const drive_config_t& c = made();
  expect_near_share(real(c.saturation.q_q30, 30), -0.09 / 7.8 / 3.0, 1e-4);
  expect_near_share(real(c.saturation.d_q30, 30), -0.017, 1e-4);
}

}  // namespace

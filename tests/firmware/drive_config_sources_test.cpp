// From the users' units to those of the optional position sources and of the start by a vector.

#include "tests/firmware/drive_config_units.hpp"

namespace {

using namespace stillspin::test;

// Half of the band is for the ripple at an edge, and centred pulses of the flux have none; 10 mA is left of any.
TEST_F(Units, TheFluxHasHalfTheBand) {
  NEEDS("sources/flux");
  parameters.drop_band = raw(0.3, 20);
  for (const bool beside : {false, true}) {
    parameters.position_source = beside ? POSITION_ENCODER : POSITION_FLUX_CONV;
    parameters.flux_beside = beside ? 1 : 0;
    EXPECT_NEAR(real(made().dead_time.band_q20, 20), 0.15, 1e-6);
    EXPECT_NEAR(real(made().dead_time.edge_band_q20, 20), 0.65, 1e-6);
  }
  parameters.drop_band = raw(0.015, 20);
  EXPECT_NEAR(real(made().dead_time.band_q20, 20), 0.01, 1e-6);
  parameters.flux_beside = 0;
  EXPECT_EQ(made().dead_time.band_q20, raw(0.015, 20));
}

TEST_F(Units, TheTurnedStart) {
  NEEDS("start/if_start");
  parameters.if_current = raw(6.5, 20);
  parameters.if_align = 321;
  parameters.if_acceleration = raw(700.0, 8);
  parameters.if_speed = raw(270.0, 8);
  parameters.if_time = 1234;
  (void)made();
  EXPECT_EQ(if_ramp_config.current_q20, parameters.if_current);
  EXPECT_EQ(if_ramp_config.align_periods, 3210);
  EXPECT_NEAR(if_ramp_config.step_bpp, 0.07 * kBppPerRpm, 1.0);
  expect_near_share(if_ramp_config.speed_bpp, 270.0 * kBppPerRpm, 1e-4);
  EXPECT_EQ(if_ramp_config.wait_periods, 12340);
}

// A rotor so light that it swings about the vector faster than can be damped matters to who turns one.
TEST_F(Units, AVectorThatCannotTurnTheShaftIsRefusedWhereItIsWanted) {
  NEEDS("start/if_start");
  parameters.if_current = raw(12.0, 20);
  parameters.magnet_flux = raw(0.9, 28);
  parameters.inertia = raw(0.0002, 24);
  EXPECT_FALSE(refused());
  parameters.start_method = 1;
  EXPECT_TRUE(refused());
}

TEST_F(Units, ThePapersObservers) {
  NEEDS("sources/paper");
  parameters.avv_bandwidth_short = raw(130.0, 8);
  parameters.avv_bandwidth_long = raw(270.0, 8);
  parameters.zvv_proportional = raw(7.0, 8);
  parameters.zvv_integral = raw(11.0, 8);
  parameters.paper_terms = 5;
  const drive_config_t& c = made();
  expect_near_share(real(c.avv.bandwidth_short_q30, 30), 130.0 * kPeriod, 1e-6);
  expect_near_share(real(c.avv.bandwidth_long_q30, 30), 270.0 * kPeriod, 1e-6);
  expect_near_share(real(paper_config.kp_q30, 30), 7.0 * kPeriod, 1e-5);
  expect_near_share(real(paper_config.ki_q40, 40), 11.0 * kPeriod * kPeriod, 1e-4);
  EXPECT_EQ(paper_config.terms, 5);
  EXPECT_GT(c.speed.trajectory_ms_q8, 512) << "another source's";
  parameters.avv_bandwidth_long = raw(90.0, 8);
  EXPECT_EQ(made().avv.bandwidth_long_q30, made().avv.bandwidth_short_q30) << "never slower with more to see";
}

// One step: none. The target is the command itself.
TEST_F(Units, ThePapersTarget) {
  NEEDS("sources/paper");
  parameters.position_source = POSITION_PAPER;
  parameters.id_low_speed = raw(8.0, 20);
  for (const bool has_trajectory : {true, false}) {
    parameters.paper_terms = has_trajectory ? 127 : 127 - 32;
    const drive_config_t& c = made();
    EXPECT_EQ(c.speed.trajectory_ms_q8, has_trajectory ? parameters.speed_trajectory : raw(1.0, 8));
    speed_controller_t s;
    ASSERT_TRUE(speed_controller_init(&s, &c.speed, &c.nameplate));
    EXPECT_EQ(s.approach_q30 == raw(1.0, 30), !has_trajectory);
  }
}

// Where the flux is at work a current's sign is trusted from half the band on.
TEST_F(Units, TheMethodIsThatOfTheSourceOrOfWhoLooksOn) {
  NEEDS("sources/flux");
  const std::int32_t band_q20 = made().dead_time.band_q20, edge_band_q20 = made().dead_time.edge_band_q20;
  EXPECT_EQ(band_q20, parameters.drop_band);
  EXPECT_EQ(edge_band_q20 - band_q20, raw(0.5, 20));
  for (int method = FLUX_CONV; method <= FLUX_ACTIVE; ++method) {
    for (const bool looks_on : {false, true}) {
      parameters.position_source = looks_on ? POSITION_ENCODER : POSITION_FLUX_CONV + method;
      parameters.flux_beside = looks_on ? 1 + method : 0;
      EXPECT_EQ(made_flux().method, method);
      EXPECT_EQ(made().dead_time.band_q20, band_q20 / 2);
      EXPECT_EQ(made().dead_time.edge_band_q20 - made().dead_time.band_q20, raw(0.5, 20));
    }
    parameters.flux_beside = 0;
    EXPECT_EQ(made().dead_time.band_q20, band_q20);
  }
}

TEST_F(Units, TheStatorFlux) {
  NEEDS("sources/flux");
  parameters.position_source = POSITION_FLUX_CONV;
  parameters.flux_cutoff = raw(31.0, 8);
  parameters.flux_bandwidth = raw(123.0, 8);
  parameters.lqq_4 = raw(80.0, 16);
  const drive_config_t c = made();
  expect_near_share(real(flux_config.cutoff_q30, 30), 31.0 * kPeriod, 1e-5);
  expect_near_share(real(flux_config.bandwidth_q30, 30), 123.0 * kPeriod, 1e-5);
  EXPECT_FALSE(flux_config.is_plain);
  parameters.flux_plain = 1;
  EXPECT_TRUE(made_flux().is_plain);
  EXPECT_FALSE(made_flux().is_printed);
  parameters.flux_plain = 2;
  EXPECT_FALSE(made_flux().is_plain);
  EXPECT_TRUE(made_flux().is_printed);
  // Once in 10 ms: 100 ms of the inductance, 200 ms of the magnet, from a twentieth of the magnet's flux on.
  const double step = flux_config.adaptation_periods * kPeriod;
  EXPECT_NEAR(step, 0.01, 1e-9);
  EXPECT_NEAR(real(flux_config.adaptation.inductance_q30, 30), step / 0.1, 1e-6);
  EXPECT_NEAR(real(flux_config.adaptation.current_q24, 24), 0.05, 1e-6);
  for (const int learn : {0, 1, 2, 3}) {
    parameters.flux_adapt = learn;
    const flux_adaptation_config_t& a = made_flux().adaptation;
    EXPECT_EQ(a.saturation_q24, (learn & 1) != 0 ? flux_adaptation_identify_q24(&c.nameplate) : 0) << learn;
    EXPECT_NEAR(real(a.magnet_q30, 30), (learn & 2) != 0 ? step / 0.2 : 0.0, 1e-6) << learn;
  }
}

// A phase without current makes its voltage itself within the dead time; where there is none all voltages are known.
TEST_F(Units, WithoutDeadTimeTheFluxSeesEveryPhase) {
  NEEDS("sources/flux");
  parameters.position_source = POSITION_FLUX_CONV;
  EXPECT_EQ(made_flux().unknown_voltage_q20, made().dead_time.band_q20);
  parameters.turn_on_delay = parameters.turn_off_delay = 0;
  parameters.dead_time = raw(0.01, 16);
  EXPECT_GT(made_flux().unknown_voltage_q20, 0);
  parameters.dead_time = 0;
  EXPECT_EQ(made_flux().unknown_voltage_q20, 0);
}

}  // namespace

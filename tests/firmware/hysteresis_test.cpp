// Hysteresis control on a board of fakes: which leg goes where, when it runs, and what its band does.

#include "tests/firmware/fake_hal.hpp"

namespace {

using namespace stillspin::test;

class Hysteresis : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    parameters.current_law = 1;
    drive.config_valid = drive_config_load(&drive.config);
    make_run();
    slice();
  }

  /// One slice with these currents, A.
  void slice(double a = 0.0, double b = 0.0) {
    board.slice.current_a = code(a);
    board.slice.current_b = code(b);
    drive_window_interrupt();
  }

  /// Twenty slices that swing as far as switches all legs, then the control interrupt.
  void swinging_period(double amps, int swings) {
    for (int n = 0; n < 20; ++n) slice((n % 2 == 1 && n / 2 < swings) ? amps : -amps, 0.0);
    drive_control_interrupt();
  }

  static std::uint16_t code(double amps) { return static_cast<std::uint16_t>(std::lround(2048.0 + amps * 102.4)); }

  double band() const { return real(drive.hysteresis.band_q20, 20); }
};

TEST_F(Hysteresis, RunsFromRunOnAndWritesNoPulses) {
  EXPECT_EQ(board.slice_ticks, 500);
  const int frames = board.frames;
  for (int n = 0; n < 5; ++n) {
    slice();
    drive_control_interrupt();
  }
  EXPECT_EQ(board.frames, frames);
  EXPECT_EQ(drive.state, DRIVE_RUN);
}

// A shaft that is brought to rest keeps its slices until the gates go off.
TEST_F(Hysteresis, BringsTheShaftToRest) {
  drive.position.encoder.speed_bpp = bpp_of(1000);
  drive_command_stop();
  drive_control_interrupt();
  ASSERT_EQ(drive.state, DRIVE_STOP);
  EXPECT_EQ(board.slice_ticks, 500);
  for (int n = 0; n < 100 && drive.state == DRIVE_STOP; ++n) {
    slice();
    drive.position.encoder.speed_bpp = 0;
    drive_control_interrupt();
  }
  EXPECT_EQ(drive.state, DRIVE_READY);
  EXPECT_EQ(board.slice_ticks, 0);
}

TEST_F(Hysteresis, EveryLegBringsItsCurrentBack) {
  // 0.4 A of band, no reference. c is what is left of a and b.
  slice(1.0, -0.5);  // a too high, b and c too low
  EXPECT_EQ(board.legs, 6);
  slice(0.3, -0.3);  // inside: everything stays
  EXPECT_EQ(board.legs, 6);
  slice(-1.0, 0.1);  // a too low, c (0.9) too high, b inside
  EXPECT_EQ(board.legs, 3);
}

TEST_F(Hysteresis, ReferenceMovesWithTheSlices) {
  drive.hysteresis.step_a_q8 = 100;
  const std::int32_t before = drive.hysteresis.reference_a_q8;
  for (int n = 0; n < 3; ++n) slice();
  EXPECT_EQ(drive.hysteresis.reference_a_q8, before + 300);
}

TEST_F(Hysteresis, MeanOfTheSlicesIsTheMeasuredCurrent) {
  drive_control_interrupt();                                         // takes what there was before
  for (int n = 0; n < 20; ++n) slice(n % 2 == 0 ? 2.2 : 1.8, -1.0);  // along phase a, where the rotor is
  drive_control_interrupt();
  // the code is rounded to 10 mA, the encoder's zero is that of the start
  EXPECT_NEAR(std::hypot(real(drive.control.measured_q20.d, 20), real(drive.control.measured_q20.q, 20)), 2.0, 0.01);
}

TEST_F(Hysteresis, BandWidensWhileTheLegsSwitchTooOften) {
  const double before = band();
  for (int n = 0; n < 300; ++n) swinging_period(2.0, 4);  // four rises a period and leg are 40 kHz
  EXPECT_GT(band(), 1.2 * before);
  EXPECT_EQ(drive.state, DRIVE_RUN);
}

TEST_F(Hysteresis, BandNarrowsWhileTheySwitchTooSeldom) {
  const double before = band();
  for (int n = 0; n < 300; ++n) swinging_period(0.1, 0);
  EXPECT_LT(band(), 0.8 * before);
}

TEST_F(Hysteresis, BandStaysWithoutAFrequency) {
  parameters.hysteresis_frequency = 0;
  const double before = band();
  for (int n = 0; n < 300; ++n) swinging_period(2.0, 4);
  EXPECT_EQ(band(), before);
}

TEST_F(Hysteresis, OverCurrentInOneSliceIsAFaultAndEndsIt) {
  slice(18.5, 0.0);  // trip_current is 18 A
  slice();
  drive_control_interrupt();
  EXPECT_EQ(drive.state, DRIVE_FAULT);
  EXPECT_EQ(drive.fault, FAULT_CURRENT_LIMIT);
  EXPECT_FALSE(board.gates_on);
  EXPECT_EQ(board.slice_ticks, 0) << "back to pulses";
}

TEST_F(Hysteresis, NoSlicesAreAFault) {
  for (int n = 0; n < 10; ++n) drive_control_interrupt();
  EXPECT_EQ(drive.fault, FAULT_NO_SAMPLES);
}

TEST_F(Hysteresis, NeedsTheEncoderAndWholeSlices) {
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  parameters.slice_time = raw(7.0, 16);
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
  parameters.slice_time = raw(10.0, 16);
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  parameters.position_source = 2;
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
}

}  // namespace

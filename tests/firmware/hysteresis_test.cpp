// Hysteresis control on a board of fakes: which leg goes where, when it runs, and what its band does.

#include <algorithm>
#include <vector>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/hysteresis/hysteresis.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

class Hysteresis : public Drive {
 protected:
  void SetUp() override {
    NEEDS("hysteresis");
    Drive::SetUp();
    use_source(POSITION_ENCODER);
    parameters.current_law = 1;
    inside::config_valid() = drive_config_load(&inside::config());
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

  /// The two hooks of the control interrupt.
  static bool take_samples() {
    return hysteresis_control.samples(&drive, &inside::samples(), &inside::current_dq_q20(),
                                      &inside::missing_windows());
  }
  static bool control_step() { return hysteresis_control.step(&drive, &inside::modulation()); }

  static std::uint16_t code(double amps) { return static_cast<std::uint16_t>(std::lround(2048.0 + amps * 102.4)); }

  double band() const { return real(::hysteresis.band_q20, 20); }
};

TEST_F(Hysteresis, RunsFromRunOnAndWritesNoPulses) {
  EXPECT_EQ(board.slice_ticks, 500);
  const int frames = board.frames;
  for (int n = 0; n < 5; ++n) {
    slice();
    drive_control_interrupt();
  }
  EXPECT_EQ(board.frames, frames);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

// A shaft that is brought to rest keeps its slices until the gates go off.
TEST_F(Hysteresis, BringsTheShaftToRest) {
  encoder.observer.speed_bpp = bpp_of(1000);
  drive_command_stop();
  drive_control_interrupt();
  ASSERT_EQ(inside::state(), DRIVE_STOP);
  EXPECT_EQ(board.slice_ticks, 500);
  for (int n = 0; n < 100 && inside::state() == DRIVE_STOP; ++n) {
    slice();
    encoder.observer.speed_bpp = 0;
    drive_control_interrupt();
  }
  EXPECT_EQ(inside::state(), DRIVE_READY);
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
  ::hysteresis.step_a_q8 = 100;
  const std::int32_t before = ::hysteresis.reference_a_q8;
  for (int n = 0; n < 3; ++n) slice();
  EXPECT_EQ(::hysteresis.reference_a_q8, before + 300);
}

TEST_F(Hysteresis, MeanOfTheSlicesIsTheMeasuredCurrent) {
  drive_control_interrupt();                                         // takes what there was before
  for (int n = 0; n < 20; ++n) slice(n % 2 == 0 ? 2.2 : 1.8, -1.0);  // along phase a, where the rotor is
  drive_control_interrupt();
  // the code is rounded to 10 mA, the encoder's zero is that of the start
  EXPECT_NEAR(std::hypot(real(inside::current_dq_q20().d, 20), real(inside::current_dq_q20().q, 20)), 2.0, 0.01);
}

TEST_F(Hysteresis, BandWidensWhileTheLegsSwitchTooOften) {
  const double before = band();
  for (int n = 0; n < 300; ++n) swinging_period(2.0, 4);  // four rises a period and leg are 40 kHz
  EXPECT_GT(band(), 1.2 * before);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

TEST_F(Hysteresis, BandNarrowsWhileTheySwitchTooSeldom) {
  const double before = band();
  for (int n = 0; n < 300; ++n) swinging_period(0.1, 0);
  EXPECT_LT(band(), 0.8 * before);
}

TEST_F(Hysteresis, BandStaysWithoutAFrequency) {
  parameters.hysteresis_frequency = 0;
  use_parameters();
  const double before = band();
  for (int n = 0; n < 300; ++n) swinging_period(2.0, 4);
  EXPECT_EQ(band(), before);
}

TEST_F(Hysteresis, BandFollowsTheLowestFrequencyToo) {
  parameters.hysteresis_frequency = raw(0.01, 16);  // less than one rise in 10 ms
  use_parameters();
  const double before = band();
  for (int n = 0; n < 300; ++n) swinging_period(0.1, 0);
  EXPECT_LT(band(), before);
}

TEST_F(Hysteresis, OverCurrentInOneSliceIsAFaultAndEndsIt) {
  slice(18.5, 0.0);  // trip_current is 18 A
  slice();
  drive_control_interrupt();
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_CURRENT_LIMIT);
  EXPECT_FALSE(board.gates_on);
  EXPECT_EQ(board.slice_ticks, 0) << "back to pulses";
}

TEST_F(Hysteresis, NoSlicesAreAFault) {
  for (int n = 0; n < 10; ++n) drive_control_interrupt();
  EXPECT_EQ(inside::fault(), FAULT_NO_SAMPLES);
}

TEST_F(Hysteresis, NeedsTheEncoderAndWholeSlices) {
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  parameters.slice_time = raw(7.0, 16);
  use_parameters();
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
  parameters.slice_time = raw(10.0, 16);
  use_parameters();
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  use_source(2);
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
}

// A current that is exactly a band away changes nothing, one code more does: each leg by its own current.
TEST_F(Hysteresis, ALegSwitchesBeyondTheBandAndStaysWithinIt) {
  hysteresis_t& h = ::hysteresis;
  h.offset_a_q8 = 2000 * 256;
  h.offset_b_q8 = 2100 * 256;
  h.step_a_q8 = h.step_b_q8 = 0;
  h.reference_a_q8 = 60 * 256;
  h.reference_b_q8 = -20 * 256;
  h.band_q8 = 41 * 256;
  const auto legs = [&h](int a, int b, std::uint16_t before) {  // codes above the references
    h.state = board.legs = before;
    board.slice.current_a = static_cast<std::uint16_t>(2060 + a);
    board.slice.current_b = static_cast<std::uint16_t>(2080 + b);
    drive_window_interrupt();
    EXPECT_EQ(h.state, board.legs) << "as it was told";
    return h.state;
  };
  for (const std::uint16_t before : {0, 7}) {
    EXPECT_EQ(legs(0, 0, before), before);
    EXPECT_EQ(legs(41, -41, before), before) << "a band too high and too low";
    EXPECT_EQ(legs(-41, 41, before), before);
    EXPECT_EQ(legs(41, 0, before), before) << "c is 41 too low";
    EXPECT_EQ(legs(-41, 0, before), before);
    EXPECT_EQ(legs(42, -20, before), before & 6);
    EXPECT_EQ(legs(-42, 20, before), before | 1);
    EXPECT_EQ(legs(-20, 42, before), before & 5);
    EXPECT_EQ(legs(20, -42, before), before | 2);
    EXPECT_EQ(legs(21, 21, before), before | 4);
    EXPECT_EQ(legs(-21, -21, before), before & 3);
  }
}

// A leg is counted when it goes high, each for itself.
TEST_F(Hysteresis, EveryLegThatGoesHighIsCounted) {
  for (std::uint16_t before = 0; before < 8; ++before) {
    for (const double a : {-1.0, 1.0}) {
      ::hysteresis.state = before;
      const std::uint16_t counted = ::hysteresis.switched;
      slice(a, -a);  // c stays
      const unsigned up = ::hysteresis.state & ~static_cast<unsigned>(before);
      EXPECT_EQ(::hysteresis.switched - counted, static_cast<int>((up & 1u) + ((up >> 1) & 1u) + (up >> 2)));
    }
  }
}

TEST_F(Hysteresis, BothReferencesMoveWithTheSlicesUpToAnEnd) {
  hysteresis_t& h = ::hysteresis;
  h.reference_a_q8 = 1000;
  h.reference_b_q8 = -2000;
  h.step_a_q8 = 70;
  h.step_b_q8 = -30;
  for (int n = 0; n < 3; ++n) slice();
  EXPECT_EQ(h.reference_a_q8, 1210);
  EXPECT_EQ(h.reference_b_q8, -2090);
  h.step_a_q8 = raw(900000.0, 8);
  h.step_b_q8 = -h.step_a_q8;
  for (int n = 0; n < 20; ++n) slice();
  EXPECT_GT(h.reference_a_q8, raw(4096.0, 8)) << "beyond any code";
  EXPECT_EQ(h.reference_b_q8, -h.reference_a_q8);
}

// From the instant at which they are set to the same instant of the next period.
TEST_F(Hysteresis, ReferencesAreThoseOfTheInstantAndGoOnForAPeriod) {
  const Vector reference = {3.0, -5.0};
  const double speed = 0.11, begin = 0.7;  // rad per period
  inside::reference_dq_q20() = raw_dq(reference, 20);
  ::hysteresis.offset_a_q8 = raw(2048.0, 8);
  for (const int tick : {0, 1234, 9999, 12000}) {
    board.pwm_tick = static_cast<std::uint16_t>(tick);
    inside::selected().angle_bam = bam(begin);
    inside::selected().speed_bpp = raw(speed / kTurn, 32);
    parameters.slice_time = raw(tick == 0 ? 5.0 : 10.0, 16);
    use_parameters();
    const int slices = tick == 0 ? 20 : 10;
    ASSERT_TRUE(control_step());
    const double passed = std::min(tick, 10000) / 10000.0;
    const auto codes = [&](double periods, double behind) {
      return reference.turned(begin + speed * periods - behind).x * 102.4;
    };
    const hysteresis_t& h = ::hysteresis;
    EXPECT_NEAR(real(h.reference_a_q8, 8), codes(passed, 0.0), 0.02) << tick;
    EXPECT_NEAR(real(h.reference_b_q8, 8), codes(passed, kTurn / 3.0), 0.02) << tick;
    EXPECT_NEAR(real(h.step_a_q8, 8), (codes(passed + 1.0, 0.0) - codes(passed, 0.0)) / slices, 0.01) << tick;
    EXPECT_NEAR(real(h.step_b_q8, 8), (codes(passed + 1.0, kTurn / 3.0) - codes(passed, kTurn / 3.0)) / slices, 0.01);
    EXPECT_NEAR(real(h.band_q8, 8), band() * 102.4, 0.01);
  }
}

// In the frame of the middle of the period that the slices were taken in, less the offsets; and the link with it.
TEST_F(Hysteresis, SlicesBecomeCurrentAndLinkOfTheirPeriod) {
  hysteresis_t& h = ::hysteresis;
  h.offset_a_q8 = raw(2048.0 + 10.24, 8);
  h.offset_b_q8 = raw(2048.0 - 20.48, 8);
  (void)take_samples();
  board.slice.link = 2000;
  inside::link_q16() = raw(300.0, 16);
  for (int n = 0; n < 5; ++n) slice(n < 3 ? 4.1 : -0.9, 2.3);  // 2.0 and 2.5 A
  inside::selected().angle_bam = bam(0.4);
  inside::selected().speed_bpp = raw(0.2 / kTurn, 32);
  inside::missing_windows() = 3;
  inside::window_count() = 2;
  (void)take_samples();
  const Vector wanted = Vector{2.0, (2.0 + 2.0 * 2.5) / std::sqrt(3.0)}.turned(-0.5);
  EXPECT_NEAR(real(inside::current_dq_q20().d, 20), wanted.x, 0.01);
  EXPECT_NEAR(real(inside::current_dq_q20().q, 20), wanted.y, 0.01);
  EXPECT_NEAR(real(inside::link_q16(), 16), 300.0 + (2000.0 / 4096.0 * 450.0 - 300.0) / 8.0, 0.01);
  EXPECT_EQ(inside::missing_windows(), 0);
  EXPECT_EQ(inside::window_count(), 0) << "of windows";
  EXPECT_EQ(inside::fault(), FAULT_NONE);
  const hysteresis_sums_t& left = h.sums;
  EXPECT_EQ(std::vector<std::int32_t>({left.a_q8, left.b_q8, left.peak_q8, left.slices}), std::vector<std::int32_t>(4));
  // Taken once: without a slice everything stays, and the period counts as one without samples.
  const dq_t before = inside::current_dq_q20();
  for (int n = 1; n < 4; ++n) {
    (void)take_samples();
    EXPECT_EQ(inside::missing_windows(), n);
    EXPECT_EQ(inside::current_dq_q20().d, before.d);
  }
  slice(1.1, -0.7);
  (void)take_samples();
  EXPECT_NEAR(std::hypot(real(inside::current_dq_q20().d, 20), real(inside::current_dq_q20().q, 20)), 1.0, 0.01)
      << "of this slice alone";
}

// Any phase in either direction, in one slice of many; and not what was there before.
TEST_F(Hysteresis, AnyPhaseTripsInEitherDirection) {
  const struct {
    double a, b;
    bool trips;
  } cases[] = {{18.2, -9.0, true}, {-18.2, 9.0, true},  {-9.0, 18.2, true},  {9.0, -18.2, true}, {9.1, 9.1, true},
               {-9.1, -9.1, true}, {17.8, -9.0, false}, {-9.0, -8.8, false}, {8.8, 9.0, false},  {-17.8, 17.8, false}};
  for (const auto& c : cases) {
    SetUp();
    slice(c.a, c.b);
    for (int n = 0; n < 19; ++n) slice();
    drive_control_interrupt();
    EXPECT_EQ(inside::fault(), c.trips ? FAULT_CURRENT_LIMIT : FAULT_NONE) << c.a << " " << c.b;
  }
}

// Every 10 ms by an eighth of what the frequency is off by, which counts as one at most.
TEST_F(Hysteresis, TheBandMovesByAnEighthOfTheFrequencysErrorEvery10Milliseconds) {
  hysteresis_t& h = ::hysteresis;
  const auto after = [&h](int kilohertz, double amps) {
    parameters.hysteresis_frequency = raw(8.0, 16);
    use_parameters();
    h.band_q20 = raw(amps, 20);
    h.periods = 0;
    h.switched = static_cast<std::uint16_t>(h.counted + 30 * kilohertz);
    for (int n = 0; n < 99; ++n) {
      (void)control_step();
      EXPECT_EQ(h.band_q20, raw(amps, 20)) << n;
    }
    (void)control_step();
    EXPECT_EQ(h.counted, h.switched);
    return real(h.band_q20, 20);
  };
  EXPECT_NEAR(after(8, 0.5), 0.5, 1e-4);
  EXPECT_NEAR(after(10, 0.5), 0.5 * (1.0 + 0.25 / 8.0), 1e-4);
  EXPECT_NEAR(after(4, 0.5), 0.5 * (1.0 - 0.5 / 8.0), 1e-4);
  EXPECT_NEAR(after(40, 0.5), 0.5 * (1.0 + 1.0 / 8.0), 1e-4);
  EXPECT_NEAR(after(40, 4.9), 5.0, 1e-4) << "5 A at most";
  EXPECT_NEAR(after(0, 0.022), 0.02, 1e-4) << "two codes at least";
}

// What windows have left from before is not taken for those of the first period with pulses.
TEST_F(Hysteresis, PulsesBeginWithoutOldWindows) {
  inside::sliced() = 0;
  for (int n = 0; n < 2; ++n) drive_window_interrupt();
  (void)control_step();
  inside::be_in(DRIVE_READY);
  EXPECT_FALSE(control_step());
  EXPECT_EQ(sampling_swap()->count, 0);
  EXPECT_EQ(sampling_swap()->count, 0);
}

// A run begins with the band of the parameter, the offsets that were found, and nothing of the run before.
TEST_F(Hysteresis, ARunBeginsAnew) {
  inside::sliced() = 0;
  ::hysteresis.sums = {1, 2, 3, 4, 5};
  ::hysteresis.state = 7;
  ::hysteresis.switched = 50;
  inside::sensor_trim().offset_a_q8 = raw(2050.0, 8);
  inside::sensor_trim().offset_b_q8 = raw(2040.0, 8);
  parameters.hysteresis_band = raw(0.3, 20);
  parameters.slice_time = raw(10.0, 16);
  use_parameters();
  board.slice_ticks = 0;
  EXPECT_TRUE(control_step());
  const hysteresis_t& h = ::hysteresis;
  EXPECT_EQ(board.slice_ticks, 1000);
  EXPECT_EQ(h.sums.slices + h.sums.a_q8 + h.sums.b_q8 + h.sums.peak_q8, 0);
  EXPECT_EQ(h.state + h.switched + h.counted, 0) << "all legs low";
  EXPECT_EQ(h.offset_a_q8, raw(2050.0, 8));
  EXPECT_EQ(h.offset_b_q8, raw(2040.0, 8));
  EXPECT_NEAR(real(h.band_q8, 8), 0.3 * 102.4, 0.01);
}

TEST_F(Hysteresis, SpaceVectorsHaveTheOtherStatesAndTheOtherLaw) {
  for (const std::int32_t law : {0, 1}) {
    for (const drive_state_t state : {DRIVE_READY, DRIVE_START, DRIVE_RUN, DRIVE_STOP, DRIVE_COMMISSION, DRIVE_FAULT}) {
      SetUp();
      parameters.current_law = law;
      use_parameters();
      inside::be_in(state);
      const bool wanted = law == 1 && (state == DRIVE_RUN || state == DRIVE_STOP);
      EXPECT_EQ(control_step(), wanted) << law << state;
      EXPECT_EQ(board.slice_ticks, wanted ? 500 : 0);
      EXPECT_EQ(inside::sliced(), wanted ? 1 : 0);
    }
  }
}

// For the virtual chip, where arithmetic takes no time by itself.
TEST_F(Hysteresis, ItsStepsSayWhatTheyTake) {
  board.profile.clear();
  slice();
  EXPECT_EQ(spent(), CYCLES_SLICE);
  board.profile.clear();
  (void)control_step();
  EXPECT_EQ(spent(), CYCLES_REFER);
}

// Nobody commands a voltage meanwhile.
TEST_F(Hysteresis, TheCurrentControlRests) {
  inside::loop_is_closed() = true;
  inside::command_dq_q16() = {raw(10.0, 16), raw(-20.0, 16)};
  inside::current_controller().q.integral_q20 = 1234567;
  inside::current_step();
  EXPECT_EQ(inside::command_dq_q16().d, 0);
  EXPECT_EQ(inside::command_dq_q16().q, 0);
  EXPECT_EQ(inside::current_controller().q.integral_q20, 0);
}

}  // namespace

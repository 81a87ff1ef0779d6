// From codes to windows: times, voltages, the filtered link; and the frames that go to the hardware.

#include <cstring>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

TEST_F(Drive, WindowsCarryTheirTimesVoltagesAndSlopes) {
  make_run();
  // There is no machine behind these windows from which a mismatch of the sensors could be learnt.
  const auto unlearn = [] { inside::sensor_trim().mismatch_q30 = 0; };
  for (int n = 0; n < 100; ++n) {  // until the scale has been renewed
    unlearn();
    period();
  }
  Random random(310);
  for (int n = 0; n < 300; ++n) {
    unlearn();
    const svpwm_pattern_t p = inside::sampled_pattern();
    // a current of 3 A along phase a that rises by some codes in each window
    hal_adc_window_t w = still_window();
    const int base = 2048 + 307;
    const int rise = random.below(41) - 20;
    w.start_a = static_cast<std::uint16_t>(4 * base);
    w.end_a = static_cast<std::uint16_t>(3 * (base + rise));
    w.start_b = static_cast<std::uint16_t>(4 * (2048 - 153));
    w.end_b = static_cast<std::uint16_t>(3 * (2048 - 153));
    period(w);
    ASSERT_EQ(inside::window_count(), p.window_count);
    for (int k = 0; k < p.window_count; ++k) {
      const estimator_window_t& e = inside::windows()[k];
      const svpwm_window_t& from = p.windows[k];
      const int begin = from.start + static_cast<int>(HAL_ADC_START_DELAY_TICKS);
      const int end = from.end + static_cast<int>(HAL_ADC_END_DELAY_TICKS);
      ASSERT_EQ(e.span_ticks, end - begin);
      ASSERT_NEAR(e.middle_tick, 0.5 * (begin + end), 0.5);
      ASSERT_EQ(e.zero_vector, from.state == 0 || from.state == 7);
      const double a = from.state & 1u, b = (from.state >> 1) & 1u, c = (from.state >> 2) & 1u;
      // less 0.95 V against each phase's current: a positive, b and c negative by half
      const double drop[] = {0.95, -0.95, -0.95};
      const double link = real(inside::link_q16(), 16);
      const Vector v = {(2.0 * a - b - c) / 3.0 * link - (2.0 * drop[0] - drop[1] - drop[2]) / 3.0,
                        (b - c) / std::sqrt(3.0) * link - (drop[1] - drop[2]) / std::sqrt(3.0)};
      // the link is filtered on from window to window: up to 0.05 V between this window and the last
      ASSERT_NEAR(real(e.voltage_q19.alpha, 19), v.x, 0.1);
      ASSERT_NEAR(real(e.voltage_q19.beta, 19), v.y, 0.1);
      // amperes per code are right to 4e-4
      ASSERT_NEAR(real(e.change_q19.alpha, 19), rise * 20.0 / 2048.0, 1e-5 + 4e-4 * std::abs(rise) * 20.0 / 2048.0);
    }
    if (inside::state() != DRIVE_RUN) break;
  }
}

// An interrupt more than a period has windows counts, and leaves the others' samples alone.
TEST_F(Drive, AWindowTooManyIsReadAndDropped) {
  (void)sampling_swap();
  for (int k = 0; k < 5; ++k) {
    hal_adc_window_t w = still_window();
    w.start_a = static_cast<std::uint16_t>(1000 + k);
    board.adc.push_back(w);
    drive_window_interrupt();
  }
  EXPECT_TRUE(board.adc.empty());
  const sampling_buffer_t* const full = sampling_swap();
  EXPECT_EQ(full->count, 5);
  for (int k = 0; k < ESTIMATOR_WINDOWS; ++k) EXPECT_EQ(full->windows[k].start_a, 1000 + k);
}

// Without a link no voltage can be had; that limits a control loop only where there is one.
TEST_F(Drive, ADriveAtRestIsNotLimited) {
  for (const bool closed : {false, true}) {
    SetUp();
    make_ready();
    inside::loop_is_closed() = closed;
    inside::current_dq_q20() = {raw(3.0, 20), 0};
    inside::command_dq_q16() = {0, 0};
    inside::config().dead_time.drop_q16 = raw(5.0, 16);  // the modulator reckons with 10 V at least
    dead_time_design(&inside::config().dead_time);
    inside::link_q16() = 0;
    inside::modulation_limits() = 0;
    inside::modulate_step();
    EXPECT_EQ(inside::modulation_limits() & LIMIT_VOLTAGE, closed ? LIMIT_VOLTAGE : 0);
  }
}

TEST_F(Drive, LinkFilterSettlesOnTheMeasurement) {
  make_ready();
  EXPECT_NEAR(real(inside::link_q16(), 16), 300.0, 0.06);  // half a code
  for (int n = 0; n < 40; ++n) period(still_window(250.0));
  EXPECT_NEAR(real(inside::link_q16(), 16), 250.0, 0.06);
}

TEST_F(Drive, EveryFrameIsOneThatTheHardwareCanDo) {
  make_run();
  Random random(311);
  inside::config().synchronism.bad_periods = 1000000;  // the windows are no machine's: it is not the subject
  drive_command_speed(raw(3000.0, 16));
  for (int n = 0; n < 3000 && inside::state() == DRIVE_RUN; ++n) {
    board.encoder = (board.encoder + 20u) & 4095u;
    hal_adc_window_t w = still_window();
    w.start_a = static_cast<std::uint16_t>(4 * (2048 + random.below(800) - 400));
    w.end_a = static_cast<std::uint16_t>(3 * (2048 + random.below(800) - 400));
    inside::avv_angle_bam() = encoder.observer.angle_bam;  // no divergence: it is not the subject
    period(w);
    const hal_pwm_frame_t& f = board.frame;
    for (int leg = 0; leg < 3; ++leg) {
      ASSERT_GE(f.edge_tick[leg], 1);
      ASSERT_LT(f.edge_tick[leg], f.edge_tick[HAL_PWM_LEGS + leg]);
      ASSERT_LE(f.edge_tick[HAL_PWM_LEGS + leg], 9999);
    }
    int last = -1000;
    for (int k = 0; k < 3; ++k) {
      if (f.burst_start_tick[k] == HAL_PWM_NONE) {
        ASSERT_EQ(f.burst_end_tick[k], HAL_PWM_NONE);
        continue;
      }
      ASSERT_GE(f.burst_start_tick[k], last + static_cast<int>(HAL_ADC_WINDOW_GAP_TICKS));
      ASSERT_GE(f.burst_end_tick[k], f.burst_start_tick[k] + HAL_ADC_BURST_TICKS);
      last = f.burst_end_tick[k];
      ASSERT_LE(last, 9640);
    }
  }
  EXPECT_GT(board.frames, 1000);
}

/// As many windows as the pattern has, one after the other, and what is made of them.
void sample(const std::vector<hal_adc_window_t>& windows) {
  for (const hal_adc_window_t& w : windows) {
    board.adc.push_back(w);
    drive_window_interrupt();
  }
  drive_read_samples(&drive, &inside::samples(), &inside::missing_windows());
}

// A link that nothing is known of is as the first windows have it; then each window moves it by an eighth.
TEST_F(Drive, TheLinkIsAMeanOfEightWindows) {
  make_ready();
  for (const double before : {0.0, 260.0}) {
    const auto count = static_cast<std::size_t>(inside::sampled_pattern().window_count);
    ASSERT_GT(count, 1u);
    inside::link_q16() = raw(before, 16);
    std::vector<hal_adc_window_t> windows;
    double mean = before == 0.0 ? real(still_window(300.0).link * inside::config().volts_per_code_q16, 16) : before;
    mean *= (8.0 - static_cast<double>(count)) / 8.0;
    for (std::size_t k = 0; k < count; ++k) {
      windows.push_back(still_window(300.0 + 10.0 * static_cast<double>(k)));
      mean += real(windows[k].link * inside::config().volts_per_code_q16, 16) / 8.0;
    }
    sample(windows);
    EXPECT_NEAR(real(inside::link_q16(), 16), mean, 1e-3) << before;
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_EQ(inside::link_end_q16()[k], windows[k].link * inside::config().volts_per_code_q16) << k;
    }
  }
}

// The input beside the currents is that of the last whole period, whatever comes in meanwhile.
TEST_F(Drive, TheAuxiliaryInputIsThatOfAWholePeriod) {
  const auto convert = [](std::uint16_t code) {
    hal_adc_window_t w = still_window();
    w.aux = code;
    board.adc.push_back(w);
    drive_window_interrupt();
  };
  (void)sampling_swap();
  std::uint16_t last = 0;
  for (const std::uint16_t code : {111, 222, 333, 444}) {
    convert(code);
    if (last != 0) {
      EXPECT_EQ(sampling_auxiliary(), last);
    }
    convert(999);  // of the period's second window
    (void)sampling_swap();
    EXPECT_EQ(sampling_auxiliary(), code);
    last = code;
  }
}

TEST_F(Drive, AResetForgetsTheWindows) {
  for (const int swaps : {0, 1}) {
    for (int k = 0; k < 2; ++k) {
      drive_window_interrupt();
      if (k < swaps) (void)sampling_swap();
    }
    sampling_reset();
    for (int k = 0; k < 2; ++k) EXPECT_EQ(sampling_swap()->count, 0) << swaps << k;
  }
}

// No window may come in while the buffers change their places.
TEST_F(Drive, BuffersAreSwappedWithTheInterruptsHeldOff) {
  const int before = board.interrupt_holds;
  (void)sampling_swap();
  EXPECT_EQ(board.interrupt_holds, before + 1);
  EXPECT_EQ(board.held_off, 0);
}

// What was learnt of the sensors is taken in its turn.
TEST_F(Drive, TheSensorsScaleIsRenewedInItsTurn) {
  make_ready();
  const slopes_scale_t before = inside::sensor_scale();
  inside::sensor_trim().mismatch_q30 = raw(0.02, 30);
  inside::sensor_trim().offset_a_q8 += 512;
  const slopes_scale_t renewed = slopes_scale(&inside::config().slopes, &inside::sensor_trim());
  ASSERT_NE(std::memcmp(&before, &renewed, sizeof before), 0);
  for (const schedule_slot_t turn : {SLOT_REGRESSION, SCHEDULE_SLOTS, SLOT_VOLTAGE}) {
    inside::scheduled_slot() = turn;
    sample(std::vector<hal_adc_window_t>(inside::sampled_pattern().window_count, still_window()));
    const slopes_scale_t& expected = turn == SLOT_VOLTAGE ? renewed : before;
    EXPECT_EQ(std::memcmp(&inside::sensor_scale(), &expected, sizeof expected), 0) << turn;
  }
}

}  // namespace

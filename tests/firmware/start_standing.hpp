// A shaft that stands when it is started, at the axis: its phases a period at a time.

#ifndef STILLSPIN_TESTS_FIRMWARE_START_STANDING_HPP
#define STILLSPIN_TESTS_FIRMWARE_START_STANDING_HPP

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
}

namespace stillspin::test {

inline constexpr double kThere = 0.7;  // the axis, rad

class StartStanding : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    parameters.flying_start = 0;
    use_parameters();
    make_ready();
    start_state.begin(&drive, DRIVE_RUN);
    ASSERT_EQ(inside::start_phase(), START_AXIS);
  }
  static drive_start_t& start() { return starting; }

  /// A period of the start, and the one that it asks for a decision alone.
  static void step() {
    const std::uint16_t before = inside::start_phase();
    start_state.step(&drive);
    inside::is_exclusive() = inside::state() == DRIVE_START && inside::wants_exclusive();
    if (!inside::is_exclusive()) return;
    EXPECT_EQ(inside::start_phase(), before);
    start_state.step(&drive);
    EXPECT_FALSE(inside::wants_exclusive());
    inside::is_exclusive() = false;
  }

  /// At the end of a phase, with AVV's angle at hand.
  static void at(start_phase_t phase, int tick, double speed = 0.0) {
    inside::start_phase() = phase;
    start().tick = static_cast<std::uint16_t>(tick - 1);
    inside::avv_angle_bam() = bam(kThere);
    inside::avv_speed_bpp() = bpp(speed);
    inside::avv_error_bam() = 0;
  }
  /// The test by saturation is over with this result.
  static void saturation_says(polarity_result_t result) {
    at(START_SATURATION, SATURATION_LENGTH + 100);
    start().saturation.tick = SATURATION_LENGTH;
    start().saturation.result = result;
    step();
  }
  /// And the one by motion: all its angles have been seen but the last.
  static void motion_says(double response) {
    at(START_MOTION, 2);
    polarity_t& m = start().motion;
    m.segment = POLARITY_SEGMENTS - 1;
    m.current_q20 = -m.current_q20;  // of the second pattern
    m.tick = static_cast<std::int16_t>(m.length - 1);
    m.response_bam = static_cast<std::int32_t>(response * m.expected_bam);
    m.rough_bam = 0;
    step();
  }
  static void expect_runs(double angle) {
    EXPECT_EQ(inside::state(), DRIVE_RUN);
    EXPECT_NEAR(wrapped(rad(inside::selected().angle_bam) - angle), 0.0, 1e-6);
  }
};

}  // namespace stillspin::test

#endif

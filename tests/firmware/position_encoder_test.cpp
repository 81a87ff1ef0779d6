// A commissioning's spin, the encoder, and who looks on beside it.

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "tests/firmware/position.hpp"

extern "C" {
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

// The spin of a commissioning runs on the observer, whatever the source.
TEST_F(Sources, ACommissioningsSpinRunsOnTheObserver) {
  run_with(POSITION_ENCODER);
  inside::be_in(DRIVE_COMMISSION);
  inside::spins() = true;
  inside::observer().angle_bam = kThere;
  encoder.observer.angle_bam = kHere;
  estimate();
  EXPECT_EQ(inside::selected().angle_bam, inside::observer().angle_bam);
  EXPECT_NEAR(rad(inside::selected().angle_bam - kThere), 0.0, 0.01);
}

// The board's counter is set up for the parameter, once.
TEST_F(Sources, TheEncodersCounterFollowsItsParameter) {
  encoder_service();
  EXPECT_EQ(board.encoder_counts, 4096u);
  board.encoder_counts = 0;
  encoder_service();
  EXPECT_EQ(board.encoder_counts, 0u) << "the count goes on";
  parameters.encoder_counts = 1000;
  encoder_service();
  EXPECT_EQ(board.encoder_counts, 1000u);
}

// Angle from the count and what was found at the start, speed by a tracking observer; the trim turns the frame alone.
TEST_F(Sources, TheEncoderHasAngleAndSpeed) {
  run_with(POSITION_ENCODER);
  board.encoder = 3000;
  inside::preset(kHere, bpp(80.0));
  EXPECT_EQ(encoder.observer.angle_bam, kHere);
  EXPECT_EQ(encoder.observer.speed_bpp, bpp(80.0));
  see(0);
  for (int n = 1; n <= 3000; ++n) {
    board.encoder = static_cast<std::uint32_t>(3000 + 3 * n) % 4096u;  // 12 electrical steps of a period
    estimate();
  }
  const double speed = 3.0 / 4096.0 * 4.0 * kTurn / kPeriod;
  EXPECT_NEAR(rad_per_s(inside::selected().speed_bpp), speed, 1e-3 * speed);
  const double angle = rad(kHere) + std::fmod(9000.0, 1024.0) / 1024.0 * kTurn;
  EXPECT_NEAR(wrapped(rad(inside::selected().angle_bam) - angle), 0.0, 0.01);
  EXPECT_EQ(inside::selected().quality_q15, 32767);
  encoder.trim_bam = bam(0.5);
  estimate();
  EXPECT_EQ(inside::low_speed_estimate().angle_bam, encoder.observer.angle_bam);
  EXPECT_EQ(inside::selected().angle_bam, encoder.observer.angle_bam + bam(0.5));
  EXPECT_EQ(inside::selected().speed_bpp, encoder.observer.speed_bpp);
}

// An angle that is off is taken up within the long windows' bandwidth, three poles at once.
TEST_F(Sources, TheEncodersObserverHasTheLongWindowsBandwidth) {
  run_with(POSITION_ENCODER);
  see(0);
  inside::preset(kHere, 0);
  encoder.observer.angle_bam = kHere - bam(0.01);
  estimate();
  EXPECT_NEAR(rad(encoder.observer.angle_bam - kHere), -0.01 * (1.0 - 3.0 * 200.0 * kPeriod), 1e-6);
}

TEST_F(Sources, TheEncodersSpeedHasTheModelsEnd) {
  run_with(POSITION_ENCODER);
  inside::preset(kHere, INT32_MAX);
  EXPECT_EQ(encoder.observer.speed_bpp, MACHINE_SPEED_END_BPP);
}

// D of the zero vectors, in the frame in use, trim included.
TEST_F(Sources, BesideTheEncoderTheDeviationIsThatOfTheFrameInUse) {
  run_with(POSITION_ENCODER);
  inside::preset(kHere, 0);
  encoder.trim_bam = bam(0.3);
  inside::windows()[0].change_q19 = raw_change({0.02, 0.01}, 3000);
  estimate();
  const Vector slope = Vector{0.02, 0.01}.turned(-rad(kHere) - 0.3);
  EXPECT_NEAR(real(inside::deviation_q20(), 20), slope.y, 1e-4);
  EXPECT_NE(inside::avv_information(), 1) << "AVV looks on";
}

// What has been seen while somebody else had the shaft is worth more than the angle in use.
TEST_F(Sources, AnEncoderThatGoesOnKeepsItsAngle) {
  run_with(POSITION_ENCODER);
  const std::uint32_t offset = encoder.offset_bam;
  board.encoder = 100;
  inside::selected().angle_bam = kThere;
  inside::keep_position();
  EXPECT_EQ(encoder.offset_bam, offset);
  EXPECT_EQ(encoder.observer.angle_bam, kHere);
  inside::preset(kThere, 0);
  EXPECT_NE(encoder.offset_bam, offset);
  EXPECT_EQ(encoder.observer.angle_bam, kThere);
}

// Beside the encoder AVV looks on in its own frame, or a stator flux in its place.
TEST_F(Sources, BesideTheEncoderSomebodyLooksOn) {
  NEEDS("sources/flux");
  for (const std::int32_t beside : {0, 1}) {
    run_with(POSITION_ENCODER);
    inside::preset(kHere, 0);
    parameters.flux_beside = beside;
    use_parameters();
    inside::avv_angle_bam() = kThere;
    see_machine(kHere);
    estimate();
    if (beside == 0) {
      EXPECT_NEAR(rad(inside::avv_error_bam()), -rad(kThere - kHere), 0.01);
      EXPECT_EQ(inside::high_speed_estimate().angle_bam, inside::avv_angle_bam());
    } else {
      EXPECT_EQ(inside::avv_error_bam(), 0);
      EXPECT_EQ(inside::high_speed_estimate().angle_bam, encoder.observer.angle_bam) << "at rest the flux follows";
    }
  }
}

// Without an encoder there is none that could be reversed, whatever the angles are.
TEST_F(Sources, OnlyAnEncoderCanBeReversed) {
  for (const std::int32_t source : {POSITION_ENCODER, POSITION_OBSERVER}) {
    run_with(source);
    inside::preset(kHere, 0);
    encoder.observer.angle_bam = kHere + 0x1000000u;
    inside::high_speed_estimate().angle_bam = kHere - 0x1000000u;
    const auto is_reversed = inside::source()->is_reversed;
    EXPECT_EQ(is_reversed != nullptr && is_reversed(&drive), source == POSITION_ENCODER);
  }
}

}  // namespace

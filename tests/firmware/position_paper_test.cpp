// The paper's source: who looks at the windows in which period, and what the other one does meanwhile.

#include "tests/firmware/position.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "firmware/sources/paper/paper.h"
}

namespace {

using namespace stillspin::test;

// The paper's idle estimator has the other one's speed and load as well.
TEST_F(Sources, ThePapersIdleEstimatorKnowsTheSpeed) {
  NEEDS("sources/paper");
  run_with(POSITION_PAPER);
  see(1);
  blend(BLEND_LOW, 1.0);
  zvv_preset(&paper_zvv, kHere, 5000, -900);
  inside::avv().observer.load_accel_q8 = 77;
  estimate();
  EXPECT_EQ(inside::avv_speed_bpp(), paper_zvv.integral_q8bpp / 256);
  EXPECT_LT(inside::avv().observer.load_accel_q8, 0);
  EXPECT_EQ(inside::avv().observer.load_accel_q8, paper_zvv.load_accel_q8);
  run_with(POSITION_PAPER);
  blend(BLEND_HIGH, 0.0);
  inside::avv_speed_bpp() = bpp_of(200);
  estimate();
  EXPECT_EQ(paper_zvv.speed_bpp, inside::avv_speed_bpp());
  EXPECT_NEAR(rad_per_s(paper_zvv.speed_bpp), 200.0 / 60.0 * kTurn * 4.0, 1.0);
}

// Below the blend long zero vectors, above it extended active ones, in it both by turns: five periods of ten each, the
// short work of ZVV beside speed control and field weakening.
TEST_F(Sources, ThePapersLayoutGoesByTurnsInTheBlend) {
  NEEDS("sources/paper");
  run_with(POSITION_PAPER);
  const position_source_t* const paper = position_sources[POSITION_PAPER];
  const auto long_zeros = [&](int rpm, blend_region_t region, double share) {
    blend(region, share);
    inside::selected().speed_bpp = bpp_of(rpm);
    std::string seen;
    for (int period = 0; period < DRIVE_PERIODS_PER_MS; ++period) {
      // what is looked at in this one
      inside::scheduled_period() =
          static_cast<std::uint16_t>((period + DRIVE_PERIODS_PER_MS - 2) % DRIVE_PERIODS_PER_MS);
      const excitation_t e = paper->excitation(&drive);
      seen += e == EXCITATION_LONG_ZERO ? 'z' : e == EXCITATION_EXTENDED ? 'e' : '?';
    }
    return seen;
  };
  EXPECT_EQ(long_zeros(44, BLEND_LOW, 1.0), "zzzzzzzzzz");
  for (const int rpm : {46, -46}) EXPECT_EQ(long_zeros(rpm, BLEND_LOW, 1.0), "zezeezezez");
  EXPECT_EQ(long_zeros(80, BLEND_BOTH, 0.5), "zezeezezez");
  EXPECT_EQ(long_zeros(101, BLEND_HIGH, 0.1), "zezeezezez") << "still mixed";
  EXPECT_EQ(long_zeros(101, BLEND_HIGH, 0.0), "eeeeeeeeee");
  parameters.paper_terms = 127 - 16;
  ASSERT_TRUE(drive_config_load(&inside::config()));
  EXPECT_EQ(long_zeros(44, BLEND_LOW, 1.0), "zzzzzzzzzz");
  EXPECT_EQ(long_zeros(80, BLEND_BOTH, 0.5), "eeeeeeeeee");
}

// Of AVV as printed nothing is regressed, and it has the angle all the same.
TEST_F(Sources, AvvAsPrintedWhereItIsAskedFor) {
  NEEDS("sources/paper");
  for (const bool printed : {false, true}) {
    run_with(POSITION_PAPER);
    if (printed) {
      parameters.paper_terms = 127 - 64;
      ASSERT_TRUE(drive_config_load(&inside::config()));
    }
    blend(BLEND_HIGH, 0.0);
    inside::selected().speed_bpp = bpp_of(200);
    see_machine(kHere);
    estimate();
    EXPECT_EQ(inside::avv_information() > 0, !printed);
  }
}

// By turns each has the windows that were made for it, and goes on meanwhile with what it knows.
TEST_F(Sources, ByTurnsEachHasItsOwnWindows) {
  NEEDS("sources/paper");
  for (const bool of_zvv : {true, false}) {
    run_with(POSITION_PAPER);
    blend(BLEND_BOTH, 0.5);
    inside::selected().speed_bpp = bpp_of(80);
    inside::reference_dq_q20().d = raw(8.0, 20);
    if (of_zvv) {
      see(1);
    } else {
      see_machine(kHere);
    }
    inside::scheduled_task() = of_zvv ? TASK_SLOT : TASK_SPEED;  // which without turns would be the other's
    estimate();
    EXPECT_EQ(paper_zvv.waited, of_zvv ? 0 : 1);
    EXPECT_EQ(inside::avv_information() > 0, !of_zvv);
  }
}

// From three quarters of the blend's lower end on they go by turns, and AVV is no longer led by ZVV.
TEST_F(Sources, BelowTheBlendAvvIsLedUntilTheTurnsBegin) {
  NEEDS("sources/paper");
  for (const int rpm : {44, 46}) {
    run_with(POSITION_PAPER);
    blend(BLEND_LOW, 1.0);
    inside::selected().speed_bpp = bpp_of(rpm);
    inside::avv_angle_bam() = kThere;
    see(1);
    estimate();
    const std::uint32_t led = rpm < 45 ? paper_zvv.angle_bam : kThere;
    EXPECT_NEAR(rad(inside::avv_angle_bam() - led), 0.0, 1e-3) << rpm;
  }
}

// What has been seen while somebody else had the shaft is worth more than the angle in use.
TEST_F(Sources, ThePapersSourceThatGoesOnKeepsItsAngle) {
  NEEDS("sources/paper");
  run_with(POSITION_PAPER);
  inside::selected().angle_bam = kThere;
  inside::keep_position();
  EXPECT_EQ(paper_zvv.angle_bam, kHere);
  inside::preset(kThere, 0);
  EXPECT_EQ(paper_zvv.angle_bam, kThere);
}

// With pulses that the parameter chooses no period is made for ZVV alone.
TEST_F(Sources, WithoutTurnsZvvLooksAtWhatThereIs) {
  NEEDS("sources/paper");
  run_with(POSITION_PAPER);
  parameters.excitation = 1;
  ASSERT_TRUE(drive_config_load(&inside::config()));
  blend(BLEND_LOW, 1.0);
  inside::selected().speed_bpp = bpp_of(50);
  inside::reference_dq_q20().d = raw(8.0, 20);
  see(2);
  inside::scheduled_task() = TASK_SLOT;
  estimate();
  EXPECT_EQ(paper_zvv.waited, 0);
}

}  // namespace

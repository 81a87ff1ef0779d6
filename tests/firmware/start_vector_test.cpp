// The I-F start of a shaft that stands: how its vector begins, and who takes over from it.

#include "tests/firmware/start_standing.hpp"

extern "C" {
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/start/if_start/if_start.h"
}

namespace {

using namespace stillspin::test;

class StartByVector : public StartStanding {
 protected:
  void SetUp() override {
    NEEDS("start/if_start");
    StartStanding::SetUp();
  }
};

// The vector turns with its own angle, with the current controllers from rest, and is not watched for its polarity.
TEST_F(StartByVector, AVectorBeginsFromRest) {
  for (const bool backward : {false, true}) {
    SetUp();
    inside::target_bpp() = backward ? -1000000 : 1000000;
    inside::current_controller().d.integral_q20 = inside::current_controller().q.integral_q20 = 99;
    inside::seen().angle_bam = 5;
    polarity_watch.open = true;
    if_ramp_phase.begin(&drive);
    EXPECT_EQ(inside::start_phase(), START_IF_RAMP);
    EXPECT_EQ(inside::current_controller().d.integral_q20 | inside::current_controller().q.integral_q20, 0);
    EXPECT_EQ(inside::seen().angle_bam, 0u);
    EXPECT_TRUE(inside::loop_is_closed());
    EXPECT_FALSE(polarity_watch.open);
    EXPECT_EQ(if_ramp.end_bpp < 0, backward);
  }
}

// What it knows of the EMF it renews beside the field's control, which has nothing to do meanwhile.
TEST_F(StartByVector, TheEmfsDirectionIsRenewedOnceInAMillisecond) {
  if_ramp_phase.begin(&drive);
  for (const task_t task : {TASK_SPEED, TASK_JUDGE_FIRST, TASK_SLOT, TASK_RENEW, TASK_JUDGE}) {
    inside::scheduled_task() = task;
    (void)if_ramp_phase.step(&drive);
    EXPECT_EQ(if_ramp.per_emf_q4.q, 0) << task;
  }
  inside::scheduled_task() = TASK_FIELD;
  (void)if_ramp_phase.step(&drive);
  EXPECT_NE(if_ramp.per_emf_q4.q, 0);
}

// Gates that the comparator does not let on are a fault, and nothing begins.
TEST_F(StartByVector, WithoutGatesNoVectorBegins) {
  start_power(&drive, false);
  board.pin_low = true;
  if_ramp_phase.begin(&drive);
  EXPECT_EQ(inside::fault(), FAULT_OVER_CURRENT);
  EXPECT_NE(inside::start_phase(), START_IF_RAMP);
  EXPECT_FALSE(inside::loop_is_closed());
  EXPECT_FALSE(inside::is_open_loop());
}

// Until the vector has reached its speed a source that would have the shaft alone knows no better than the vector; one
// that has something of its own is led along.
TEST_F(StartByVector, ASourceThatRestsSeesTheVector) {
  for (const std::int32_t source : {POSITION_OBSERVER, POSITION_FLUX_CONV}) {
    if (!has_source(source)) continue;
    SetUp();
    use_source(source);
    if_ramp_phase.begin(&drive);
    inside::transfer_position();
    inside::selected() = {bam(0.3), bpp(60.0), 0, 32767};
    flux_observer.observer.angle_bam = inside::observer().angle_bam = bam(2.0);
    estimator_input_t in = {};
    in.model = &inside::model();
    const estimator_output_t in_use = if_ramp_phase.estimate(&drive, &inside::estimate(), &in);
    EXPECT_EQ(inside::seen().angle_bam, bam(0.3)) << source;
    EXPECT_EQ(inside::seen().speed_bpp, bpp(60.0)) << source;
    EXPECT_EQ(inside::observer().angle_bam, bam(2.0)) << "it is not asked";
    EXPECT_EQ(flux_observer.observer.angle_bam == bam(0.3), source == POSITION_FLUX_CONV) << source;
    EXPECT_EQ(in_use.angle_bam, if_ramp.angle_bam + static_cast<std::uint32_t>(if_ramp.speed_bpp));
  }
}

// What the vector has turned is taken over as the source sees it: angle, speed and the current in its frame; the
// controllers begin anew in that frame, and nobody holds the shaft.
TEST_F(StartByVector, TheSourceTakesOverWhereTheVectorIs) {
  NEEDS("sources/flux");
  use_source(POSITION_FLUX_CONV);
  if_ramp_phase.begin(&drive);
  if_start_t& if_start = if_ramp;
  inside::current_controller().d.integral_q20 = inside::current_controller().q.integral_q20 = 99;
  brake_release_hold.left = 7;
  flux_observer.form.cutoff_q30 = 99;  // it was set to what was seen while nobody used it
  for (int n = 0; inside::state() == DRIVE_START && n < 100000; ++n) {
    inside::selected().angle_bam = if_start.vector_bam;
    inside::seen() = {if_start.vector_bam - bam(0.4), if_start.speed_bpp, 0, 32767};
    inside::command_dq_q16() = {0, 0};
    step();
  }
  ASSERT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_EQ(inside::ramped_bpp(), if_ramp_config.speed_bpp);
  EXPECT_EQ(inside::selected().angle_bam, inside::seen().angle_bam);
  EXPECT_EQ(flux_observer.form.cutoff_q30, 0) << "from here on the flux keeps what it knows";
  EXPECT_EQ(inside::current_controller().d.integral_q20 | inside::current_controller().q.integral_q20, 0);
  EXPECT_EQ(inside::reference_dq_q20().d, 0);
  EXPECT_NEAR(real(inside::reference_dq_q20().q, 20), real(if_start.current_q20, 20) * std::sin(0.4), 0.05);
  EXPECT_EQ(brake_release_hold.left, 0u);
}

// Behind it comes what the start was begun for: a run, or the spin of a commissioning, which has speed control as well.
TEST_F(StartByVector, TheStateBehindItBeginsAndACommissioningSpins) {
  NEEDS("commissioning");
  for (const drive_state_t behind : {DRIVE_RUN, DRIVE_COMMISSION}) {
    SetUp();
    if_ramp_phase.begin(&drive);
    inside::state_behind() = behind;
    for (int n = 0; inside::state() == DRIVE_START && n < 100000; ++n) {
      inside::selected().angle_bam = if_ramp.vector_bam;
      inside::seen() = {if_ramp.vector_bam - bam(0.4), if_ramp.speed_bpp, 0, 32767};
      inside::command_dq_q16() = {0, 0};
      step();
    }
    EXPECT_EQ(inside::state(), behind);
    EXPECT_EQ(inside::spins(), behind == DRIVE_COMMISSION);
    EXPECT_FALSE(inside::is_open_loop());
  }
}

// The flux that takes over above its blend has the shaft from the start on; nobody else does.
TEST_F(StartByVector, AFluxThatTakesOverHasTheShaftAlone) {
  NEEDS("sources/flux");
  for (const std::int32_t source : {POSITION_OBSERVER, POSITION_FLUX_CONV, POSITION_FLUX_ACTIVE}) {
    for (const int above : {0, 1}) {
      SetUp();
      use_source(source);
      inside::config().blend.high_bpp = if_ramp_config.speed_bpp - above;
      inside::blend_region() = BLEND_LOW;
      inside::blend_share_q15() = 32767;
      if_ramp_phase.begin(&drive);
      const bool alone = source >= POSITION_FLUX_CONV && above != 0;
      EXPECT_EQ(inside::blend_region(), alone ? BLEND_HIGH : BLEND_LOW) << source;
      EXPECT_EQ(inside::blend_share_q15(), alone ? 0 : 32767) << source;
    }
  }
}

TEST_F(StartByVector, AVectorThatTheShaftDoesNotFollowIsAFault) {
  if_ramp_phase.begin(&drive);
  for (int n = 0; inside::state() == DRIVE_START && n < 100000; ++n) {
    inside::seen() = {if_ramp.vector_bam + ANGLE_BAM_HALF_TURN, 0, 0, 32767};
    inside::command_dq_q16() = {0, 0};
    step();
  }
  EXPECT_EQ(inside::fault(), FAULT_DIVERGENCE);
  EXPECT_FALSE(board.gates_on);
}

}  // namespace

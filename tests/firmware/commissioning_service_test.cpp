// What the background level does beside a commissioning that runs, and what the command for one changes before it.

#include "tests/firmware/commissioning_phases.hpp"

namespace {

using namespace stillspin::test;

// What is worked out on the way says nothing of how it ends.
TEST_F(Phases, WhatIsWorkedOutMeanwhileEndsNothing) {
  commissioning_t& c = commissioning;
  for (const bool motion : {true, false}) {
    c.outcome = COMMISSIONING_RUNNING;
    c.phase = COMMISSIONING_MAP;
    c.solve_motion = motion;
    c.map.judge = !motion;
    commissioning_service(&drive);
    EXPECT_EQ(c.outcome, COMMISSIONING_RUNNING) << motion;
    EXPECT_EQ(c.phase, COMMISSIONING_MAP) << motion;
    EXPECT_FALSE(c.solve_motion) << "once";
    EXPECT_FALSE(c.map.judge) << "once";
  }
}

// A fault ends the one that it falls into, not one that was over before.
TEST_F(Phases, AFaultEndsTheOneThatRunsAlone) {
  commissioning_t& c = commissioning;
  for (const commissioning_outcome_t before : {COMMISSIONING_RUNNING, COMMISSIONING_DONE, COMMISSIONING_ABORTED}) {
    inside::be_in(DRIVE_FAULT);
    c.outcome = before;
    c.phase = COMMISSIONING_SPIN;
    commissioning_service(&drive);
    const bool ran = before == COMMISSIONING_RUNNING;
    EXPECT_EQ(c.outcome, ran ? COMMISSIONING_FAILED : before);
    EXPECT_EQ(c.phase, ran ? COMMISSIONING_IDLE : COMMISSIONING_SPIN);
  }
}

// The samples keep 5 us more off the edges, as far as the pulse leaves room for them, and never less than before.
TEST_F(Phases, TheSamplesSettleForLonger) {
  const struct {
    int pulse_ticks, settle_ticks, longer;
  } cases[] = {{3000, 800, 1300}, {2600, 800, 1240}, {2000, 800, 850}, {1800, 800, 800}};  // 13/20 less 4.5 us
  for (const auto& c : cases) {
    drive_config_t made = inside::config();
    sampling_config_t& s = made.modulator.sampling;
    made.modulator.pulse_ticks = static_cast<std::int16_t>(c.pulse_ticks);
    s.settle_ticks = static_cast<std::int16_t>(c.settle_ticks);
    commissioning.sampling = SAMPLING_USUAL;
    EXPECT_EQ(commissioning_part.make(&made), PACKED_NONE);
    EXPECT_EQ(s.settle_ticks, c.settle_ticks) << "it does not run";
    commissioning.sampling = SAMPLING_LONGER;
    EXPECT_EQ(commissioning_part.make(&made), PACKED_NONE);
    EXPECT_EQ(s.settle_ticks, c.longer) << c.pulse_ticks;
    EXPECT_EQ(made.modulator.pulse_ticks, c.pulse_ticks);
  }
}

// The command has it in the configuration before it begins, however often it comes; one that does not begin, or is
// over, leaves nothing of it behind.
TEST_F(Phases, TheSamplesSettleAsBeforeWhenItIsOver) {
  const std::int16_t usual = inside::config().modulator.sampling.settle_ticks;
  for (int n = 0; n < 2; ++n) {
    drive_command_commission();
    EXPECT_EQ(inside::config().modulator.sampling.settle_ticks, usual + 500) << n;
    EXPECT_FALSE(inside::reload_requested()) << n;
  }
  commissioning_service(&drive);
  EXPECT_EQ(commissioning.sampling, SAMPLING_LONGER) << "it is about to begin";
  inside::withdraw_state();
  commissioning.outcome = COMMISSIONING_DONE;
  commissioning_service(&drive);
  EXPECT_TRUE(inside::reload_requested());
  drive_exchange();
  EXPECT_EQ(inside::config().modulator.sampling.settle_ticks, usual);
}

}  // namespace

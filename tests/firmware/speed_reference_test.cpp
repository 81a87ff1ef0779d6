// What the speed law is told to follow, and what has its own period beside it.

#include "tests/firmware/speed_control.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

class SpeedReference : public SpeedTask {};

// A shaft that may not be braked as fast as the ramp falls would be braked on when it has long been told to speed up
// again: the ramp waits for it, and only for that.
TEST_F(SpeedReference, TheRampWaitsForAShaftThatMayNotBeBraked) {
  for (const int sign : {1, -1}) {
    for (const int limits : {0, int{LIMIT_BRAKING}, int{LIMIT_CURRENT}}) {
      for (const double target : {100.0, 500.0}) {
        SetUp();
        speed(sign * 300.0);
        inside::config().ramp_step_bpp = 1000;
        const std::int32_t before = inside::ramped_bpp() = bpp(sign * 290.0);
        inside::target_bpp() = bpp(sign * target);
        inside::limits() = limits;
        part(TASK_SPEED);
        const bool slower = target < 300.0;
        const int steps = slower ? ((limits & LIMIT_BRAKING) != 0 ? 0 : -1) : 1;
        EXPECT_EQ(inside::ramped_bpp() - before, sign * steps * 1000) << limits << " " << target;
      }
    }
  }
}

// The place that is kept is a speed beside the ramp's: back to where the shaft was.
TEST_F(SpeedReference, AShaftThatIsPushedAwayIsDrivenBack) {
  parameters.position_hold = 1280;
  ASSERT_TRUE(drive_config_load(&inside::config()));
  for (const double off : {0.3, -0.3}) {
    position_hold_release(&inside::position_hold());
    inside::selected().angle_bam = bam(1.0);
    part(TASK_SPEED);
    position_hold_t place = inside::position_hold();
    speed_controller_t law = inside::speed_controller();
    inside::selected().angle_bam = bam(1.0 + off);
    part(TASK_SPEED);
    const std::int32_t back = position_hold_step(&place, bam(1.0 + off), inside::config().hold_gain_q30);
    ASSERT_GT(std::abs(back), 100);
    EXPECT_EQ(back < 0, off > 0.0);
    const speed_controller_input_t in = {back, 0, 0, 0, raw(-10.0, 20), raw(10.0, 20)};
    EXPECT_EQ(inside::reference_dq_q20().q, speed_controller_step(&law, SPEED_PREDICTIVE, &in)) << off;
  }
}

// Once in a millisecond, where the angle is judged as well.
TEST_F(SpeedReference, CoggingIsLearntWhereTheAngleIsJudged) {
  for (const task_t task : {TASK_SPEED, TASK_JUDGE_FIRST, TASK_SLOT, TASK_RENEW, TASK_FIELD, TASK_JUDGE}) {
    for (const bool judges : {false, true}) {
      inside::config().observer.cogging.order = 6;
      inside::observer().cogging.order = 0;
      inside::observer().p_aa = 0;
      inside::judges_synchronism() = judges;
      part(task);
      EXPECT_EQ(inside::observer().cogging.order, task == TASK_JUDGE_FIRST && judges ? 6 : 0) << task;
    }
  }
}

// An ampere's torque is that of the magnet and of the saliency at the reference of i_d.
TEST_F(SpeedReference, TheTorqueOfAnAmpereFollowsTheField) {
  const Motor m;
  for (const double id : {0.0, -5.0, 2.0}) {
    inside::reference_dq_q20().d = raw(id, 20);
    const q_inverse_t before = inside::per_torque_constant();
    part(TASK_SLOT);
    EXPECT_EQ(q_over(1 << 20, inside::per_torque_constant(), 24), q_over(1 << 20, before, 24));
    part(TASK_JUDGE);
    const double per_ampere = 1.5 * m.pole_pairs * (m.flux + (m.ld - m.lq) * id);
    EXPECT_NEAR(real(q_over(1 << 20, inside::per_torque_constant(), 24), 20), 1.0 / per_ampere, 1e-3) << id;
  }
}

}  // namespace

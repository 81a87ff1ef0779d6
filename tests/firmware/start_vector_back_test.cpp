// The vector of the I-F start takes a rotor back that it cannot be seen without: when, with which vector, and where to.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/start/if_start/if_start.h"
#include "firmware/start/start.h"
}

namespace {

using namespace stillspin::test;

class VectorBack : public Drive {
 protected:
  void SetUp() override {
    NEEDS("start/if_start");
    Drive::SetUp();
    parameters.start_method = 1;
    parameters.inductance_d = parameters.inductance_q = raw(6.0, 20);
    use_parameters();
  }
  /// Running: these speeds as shares of if_speed.
  void run(double reference, double target) {
    use_parameters();
    drive_enter(&drive, DRIVE_RUN);
    inside::loop_is_closed() = true;
    inside::ramped_bpp() = at(reference);
    inside::target_bpp() = at(target);
    inside::selected() = {bam(0.5), at(reference), 0, 32767};
    inside::per_torque_constant() = q_invert(inside::model().torque_q24);
  }
  /// A start from rest.
  static void begin() {
    drive_enter(&drive, DRIVE_READY);
    start_state.begin(&drive, DRIVE_RUN);
    if_ramp_phase.begin(&drive);
  }
  static std::int32_t at(double share) { return static_cast<std::int32_t>(share * if_ramp_config.speed_bpp); }
  static void step() { if_run_state.step(&drive); }
  /// A millisecond of the phase.
  static void turn() {
    inside::command_dq_q16() = {0, 0};
    for (int n = 0; n < DRIVE_PERIODS_PER_MS; ++n) {
      inside::scheduled_task() = (n == 0) ? TASK_FIELD : TASK_SLOT;
      (void)if_ramp_phase.step(&drive);
    }
  }
};

// Below if_speed, unless the speed rises beyond it, the way it goes already.
TEST_F(VectorBack, ASpeedThatTheEmfDoesNotShowIsTheVectors) {
  const struct {
    double reference, target;
    bool taken;
  } cases[] = {{1.01, 0.0, false}, {0.99, 0.0, true},   {0.99, 0.5, true},    {0.99, 2.0, false}, {0.99, -2.0, true},
               {0.0, -2.0, true},  {-0.99, 2.0, true},  {-0.99, -2.0, false}, {-0.5, 0.0, true},  {2.0, -2.0, false},
               {0.5, 0.5, true},   {-1.01, 2.0, false}, {0.99, 1.0, false}};
  for (const auto& c : cases) {
    run(c.reference, c.target);
    step();
    EXPECT_EQ(inside::state(), c.taken ? DRIVE_START : DRIVE_RUN) << c.reference << " " << c.target;
    EXPECT_EQ(inside::is_open_loop(), c.taken);
    if (!c.taken) continue;
    EXPECT_EQ(inside::state_behind(), DRIVE_RUN);
    EXPECT_EQ(inside::unseen(), KNOWN_ROTOR);
    EXPECT_EQ(inside::invalid_periods(), 0u) << "the power stage stays on";
    EXPECT_EQ(inside::start_phase(), START_IF_RAMP);
    EXPECT_TRUE(inside::loop_is_closed());
  }
}

// A saliency shows the rotor at every speed, from where Lq is an eighth above Ld; so does a start without a vector.
TEST_F(VectorBack, NoRotorThatIsSeenIsTaken) {
  const struct {
    double lq_mh;
    int method;
    bool taken;
  } cases[] = {{6.0, 1, true}, {6.74, 1, true}, {6.76, 1, false}, {9.0, 1, false}, {6.0, 0, false}};
  for (const auto& c : cases) {
    parameters.inductance_q = raw(c.lq_mh, 20);
    parameters.start_method = c.method;
    run(0.5, 0.0);
    step();
    EXPECT_EQ(inside::state() == DRIVE_START, c.taken) << c.lq_mh << " " << c.method;
  }
}

// What the current makes of torque it goes on making: the vector is twice as long as the load's current, and ahead of
// the rotor by where that part of it is across. What was measured and summed up stands still while the frame moves.
TEST_F(VectorBack, TheVectorBearsTheLoadFromTheFirstPeriodOn) {
  for (const double amperes : {-12.0, -6.0, -2.0, 0.0, 3.0, 5.0, 13.0}) {
    run(0.9, 0.0);
    const double nm = amperes * real(inside::model().torque_q24, 24);
    inside::selected().load_accel_q8 = static_cast<std::int32_t>(nm * real(inside::model().accel_q12, 12) * 256.0);
    inside::current_dq_q20() = raw_dq({0.5, amperes}, 20);
    inside::current_controller().d.integral_q20 = raw(3.0, 20);
    inside::current_controller().q.integral_q20 = raw(-20.0, 20);
    polarity_watch.open = true;
    step();
    const double limit = real(parameters.current_limit, 20);
    const double length = std::clamp(2.0 * std::fabs(amperes), real(parameters.if_current, 20), limit);
    const double ahead = amperes / length;
    EXPECT_NEAR(real(if_ramp.current_q20, 20), length, 0.01) << amperes;
    EXPECT_NEAR(rad(if_ramp.vector_bam - bam(0.5)), ahead, 0.002);
    EXPECT_EQ(inside::selected().angle_bam, if_ramp.vector_bam);
    EXPECT_EQ(inside::seen().angle_bam, bam(0.5));
    EXPECT_NEAR(real(inside::reference_dq_q20().d, 20), length, 0.01);
    EXPECT_EQ(inside::reference_dq_q20().q, 0);
    EXPECT_NEAR(real(inside::current_dq_q20().d, 20), 0.5 * std::cos(ahead) + amperes * std::sin(ahead), 0.05);
    EXPECT_NEAR(real(inside::current_controller().d.integral_q20, 20), 3.0 * std::cos(ahead) - 20.0 * std::sin(ahead),
                0.05);
    EXPECT_NEAR(real(inside::current_controller().q.integral_q20, 20), -20.0 * std::cos(ahead) - 3.0 * std::sin(ahead),
                0.05);
    EXPECT_FALSE(polarity_watch.open);
  }
}

// It turns as is commanded, down to standstill; for a speed that shows the rotor, as fast as the source takes over.
TEST_F(VectorBack, TheVectorGoesWhereTheCommandSays) {
  run(0.9, 0.3);
  step();
  EXPECT_EQ(if_ramp.end_bpp, at(0.3));
  for (const double target : {0.0, -0.4, -1.0, -3.0, 3.0, 0.99}) {
    inside::target_bpp() = at(target);
    turn();
    const double share = (std::fabs(target) < 1.0) ? target : std::copysign(1.0, target);
    EXPECT_NEAR(if_ramp.end_bpp, at(share), 1.0) << target;
  }
}

// A start goes to if_speed, whatever is commanded meanwhile: only then it is over.
TEST_F(VectorBack, AStartGoesAllTheWay) {
  begin();
  inside::target_bpp() = 0;
  turn();
  EXPECT_EQ(if_ramp.end_bpp, if_ramp_config.speed_bpp);
}

// Near standstill nothing is seen: the source begins where the vector is, with each period anew.
TEST_F(VectorBack, NearStandstillTheSourceWaits) {
  run(0.9, 0.0);
  step();
  for (const double share : {0.6, 0.4, 0.0, -0.4, -0.6}) {
    if_ramp.speed_bpp = at(share);
    inside::selected() = {bam(1.5), at(share), 0, 32767};
    inside::observer().angle_bam = bam(-1.0);
    estimator_input_t in = {};
    in.model = &inside::model();
    (void)if_ramp_phase.estimate(&drive, &inside::estimate(), &in);
    EXPECT_EQ(inside::observer().angle_bam == bam(1.5), std::fabs(share) < 0.5) << share;
  }
}

// While the vector rests, what its voltage is more than expected is resistance, more of it or less, in a drive that
// knows what its devices take.
TEST_F(VectorBack, AWindingThatIsWarmOrColdIsMeasuredAtRest) {
  const struct {
    double more;
    int mismatch;
    double lq_mh;
    bool taken;
  } cases[] = {{0.15, 1, 6.0, true}, {-0.06, -1, 6.0, true}, {0.15, 0, 6.0, false}, {0.15, 1, 9.0, false}};
  for (const auto& c : cases) {
    SetUp();
    parameters.inductance_q = raw(c.lq_mh, 20);
    use_parameters();
    inside::config().sensor_mismatch_q30 = c.mismatch;
    begin();
    const double resistance = real(inside::model().nominal_rs_q24, 24) + c.more;
    for (int n = 0; n < if_ramp_config.align_periods; ++n) {
      inside::scheduled_task() = (n % DRIVE_PERIODS_PER_MS == 5) ? TASK_FIELD : TASK_SLOT;
      inside::command_dq_q16() = {raw(real(if_ramp.current_q20, 20) * resistance, 16), 0};
      (void)if_ramp_phase.step(&drive);
    }
    // The mean of 100 ms lacks exp(-2.4) of what the ramp before, 250 ms long, has left it behind by.
    EXPECT_NEAR(real(inside::model().trim.rs_q24, 24), c.taken ? c.more : 0.0, 0.04 * std::fabs(c.more))
        << c.more << " " << c.mismatch << " " << c.lq_mh;
  }
}

// The current is controlled at the ends of the periods; the winding's voltage is that of the mean, ripple and all.
TEST_F(VectorBack, TheMeanCurrentOfARestingVectorHasTheRipple) {
  use_parameters();
  inside::config().sensor_mismatch_q30 = 1;
  begin();
  inside::link_q16() = raw(300.0, 16);
  const double edges[2][3][2] = {{{400.0, 5400.0}, {3000.0, 9500.0}, {2600.0, 8600.0}},
                                 {{900.0, 6900.0}, {3300.0, 9300.0}, {2000.0, 8400.0}}};
  double mean[3] = {0.0, 0.0, 0.0};  // of each leg's ripple flux, of the link's voltage and a period
  for (int n = 0; n < 2; ++n) {
    for (std::uint16_t leg = 0; leg < 3; ++leg) {
      const double rise = edges[n][leg][0], fall = edges[n][leg][1];
      svpwm_put_pulse(&inside::patterns()[n].pulses, leg, static_cast<int>(rise), static_cast<int>(fall - rise));
      for (int tick = 0; tick < 10000; ++tick) {
        const double t = tick + 0.5;
        mean[leg] += (std::clamp(t - rise, 0.0, fall - rise) - (fall - rise) * t / 1e4) / 1e8 / 2.0;
      }
    }
  }
  const Vector flux = Vector{(2.0 * mean[0] - mean[1] - mean[2]) / 3.0, (mean[1] - mean[2]) / std::sqrt(3.0)} * 300.0;
  const double resistance = 1.1 * real(inside::model().nominal_rs_q24, 24);
  const double more = flux.x * real(inside::model().yd_q30, 30);  // the vector ends on the alpha axis
  EXPECT_GT(std::fabs(more), 0.2);
  for (int n = 0; n < if_ramp_config.align_periods; ++n) {
    inside::scheduled_task() = (n % DRIVE_PERIODS_PER_MS == 5) ? TASK_FIELD : TASK_SLOT;
    const double length = real(if_ramp.current_q20, 20) + more;
    inside::command_dq_q16() = {raw(length * resistance, 16), 0};
    (void)if_ramp_phase.step(&drive);
  }
  // As above; without the ripple it would be off by 0.07.
  EXPECT_NEAR(real(inside::model().trim.rs_q24, 24), resistance / 11.0, 0.008 * resistance);
}

}  // namespace

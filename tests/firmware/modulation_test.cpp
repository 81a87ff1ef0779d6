// From the voltage command to the frame that the hardware gets, and the current control before it: on a drive that the
// test has put where it wants it.

#include <algorithm>
#include <cstring>
#include <iterator>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/mode/states.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
#include "svpwm/ripple.h"
}

namespace {

using namespace stillspin::test;

class Modulation : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    make_ready();
    inside::be_in(DRIVE_RUN);
    polarity_watch.open = false;
    inside::loop_is_closed() = true;
    inside::link_q16() = raw(300.0, 16);
    inside::selected() = {bam(0.3), raw(0.12 / kTurn, 32), 0, 32767};
    inside::command_dq_q16() = raw_dq({20.0, 35.0}, 16);
    inside::current_dq_q20() = raw_dq({1.5, -4.0}, 20);
    inside::modulation_limits() = 0;
  }
  /// The pulses of this excitation, and whether they are those that the drive makes.
  static bool modulates_as(excitation_t excitation) {
    modulator_t state = inside::modulator();
    inside::modulate_step();
    svpwm_pulses_t wanted = {};
    (void)modulator_step(&state, &inside::config().modulator, excitation, inside::modulated_q16(), inside::link_q16(),
                         &wanted);
    return std::memcmp(wanted.at, inside::running_pattern().pulses.at, sizeof wanted.at) == 0;
  }
};

// The voltage acts in the next period, whose middle is one and a half periods on; the devices' drops are added.
TEST_F(Modulation, TheVoltageIsTurnedToWhereTheRotorWillBe) {
  for (const double speed : {0.12, -0.5}) {
    inside::selected().speed_bpp = raw(speed / kTurn, 32);
    inside::modulate_step();
    const double angle = 0.3 + 1.5 * speed;
    const Vector current = Vector{1.5, -4.0}.turned(angle);
    const Vector drop = real(dead_time_drop_q16(&inside::config().dead_time, raw_ab(current, 20)), 16);
    EXPECT_GT(drop.length(), 0.5);
    const Vector wanted = Vector{20.0, 35.0}.turned(angle) + drop;
    EXPECT_NEAR(real(inside::modulated_q16().alpha, 16), wanted.x, 1e-3);
    EXPECT_NEAR(real(inside::modulated_q16().beta, 16), wanted.y, 1e-3);
    // and that is what the motor gets
    const Vector mean = real(svpwm_mean_q16(&inside::running_pattern().pulses, inside::link_q16()), 16);
    EXPECT_NEAR((mean - wanted).length(), 0.0, 0.1);
  }
}

TEST_F(Modulation, TheFrameIsThePatternsWithItsEdgesAdvanced) {
  inside::modulate_step();
  const svpwm_pattern_t& p = inside::running_pattern();
  const hal_pwm_frame_t& f = board.frame;
  ASSERT_EQ(p.window_count, 2);
  const dead_time_config_t& c = inside::config().dead_time;
  // As far as the current at the edge says: by the blocked or the released time, never more.
  int blocked = 0, released = 0;
  for (std::uint16_t leg = 0; leg < 3; ++leg) {
    for (const int shift : {p.pulses.at[leg] - f.edge_tick[leg], p.pulses.at[3 + leg] - f.edge_tick[3 + leg]}) {
      EXPECT_GE(shift, c.turn_off_ticks);
      EXPECT_LE(shift, c.turn_on_ticks);
      blocked += shift == c.turn_on_ticks;
      released += shift == c.turn_off_ticks;
    }
  }
  EXPECT_GT(blocked, 0);
  EXPECT_GT(released, 0);
  svpwm_pattern_t again = p;
  std::uint16_t edges[SVPWM_EDGES];
  const double angle = 0.3 + 1.5 * 0.12;
  const machine_model_t& m = inside::model();
  const svpwm_carried_t carried = {dead_time_shares_q12(&c, raw_ab(Vector{1.5, -4.0}.turned(angle), 20)),
                                   (m.yd_q30 + m.yq_q30) / 2, inside::link_q16()};
  svpwm_compensate_edges(&c, &inside::config().modulator.sampling, &carried, &again, edges);
  for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) EXPECT_NEAR(f.edge_tick[edge], edges[edge], 1) << edge;
  for (int k = 0; k < 3; ++k) {
    const bool used = k < p.window_count;
    EXPECT_EQ(f.burst_start_tick[k], used ? p.windows[k].start : HAL_PWM_NONE);
    EXPECT_EQ(f.burst_end_tick[k], used ? p.windows[k].end : HAL_PWM_NONE);
  }
}

// For the virtual chip: before the write, which may be too late by it.
TEST_F(Modulation, ItsStepSaysWhatItTakes) {
  for (const bool shorted : {false, true}) {
    board.profile.clear();
    inside::be_in(DRIVE_START);
    inside::is_shorted() = shorted;
    inside::modulate_step();
    EXPECT_EQ(spent(), CYCLES_MODULATE);
  }
}

// What was read belongs to the period before; a frame that came too late leaves the one that runs, and is counted.
TEST_F(Modulation, AFrameThatIsLateLeavesThePatternThatRuns) {
  inside::modulate_step();
  inside::selected().angle_bam = bam(2.0);
  const svpwm_pattern_t first = inside::running_pattern();
  board.late = true;
  for (int n = 1; n < 4; ++n) {
    inside::modulate_step();
    EXPECT_EQ(inside::overruns(), n);
    EXPECT_EQ(inside::modulation_limits() & LIMIT_OVERRUN, LIMIT_OVERRUN);
    EXPECT_EQ(std::memcmp(&first, &inside::running_pattern(), sizeof first), 0);
    EXPECT_EQ(std::memcmp(&first, &inside::sampled_pattern(), sizeof first), 0);
  }
  board.late = false;
  inside::modulation_limits() = 0;
  inside::modulate_step();
  EXPECT_EQ(inside::overruns(), 0) << "in a row";
  EXPECT_EQ(inside::modulation_limits() & LIMIT_OVERRUN, 0);
  EXPECT_EQ(std::memcmp(&first, &inside::sampled_pattern(), sizeof first), 0);
  EXPECT_NE(std::memcmp(&first, &inside::running_pattern(), sizeof first), 0);
}

// A frame that is late, or a voltage that the link has not, is told until the next millisecond begins, beside the
// speed control's limits.
TEST_F(Modulation, ALimitIsToldForItsMillisecond) {
  inside::limits() = LIMIT_CURRENT | LIMIT_BRAKING;
  inside::scheduled_task() = TASK_SLOT;
  board.late = true;
  inside::modulate_step();
  EXPECT_EQ(inside::all_limits(), LIMIT_CURRENT | LIMIT_BRAKING | LIMIT_OVERRUN);
  board.late = false;
  inside::command_dq_q16() = raw_dq({-150.0, 250.0}, 16);
  inside::modulate_step();
  EXPECT_EQ(inside::all_limits(), LIMIT_CURRENT | LIMIT_BRAKING | LIMIT_OVERRUN | LIMIT_VOLTAGE);
  inside::scheduled_task() = TASK_SPEED;
  inside::modulate_step();
  EXPECT_EQ(inside::all_limits(), LIMIT_CURRENT | LIMIT_BRAKING | LIMIT_VOLTAGE);
}

// The excess that the link cannot give comes off the integrators, along the axes in which it was asked.
TEST_F(Modulation, AVoltageThatTheLinkHasNotComesOffTheIntegrators) {
  for (const bool closed : {true, false}) {
    SetUp();
    inside::loop_is_closed() = closed;
    inside::current_dq_q20() = {0, 0};
    inside::command_dq_q16() = raw_dq({-150.0, 250.0}, 16);
    current_controller_t& c = inside::current_controller();
    c.d.integral_q20 = raw(-150.0, 20);
    c.q.integral_q20 = raw(250.0, 20);
    inside::modulate_step();
    EXPECT_EQ(inside::modulation_limits() & LIMIT_VOLTAGE, closed ? LIMIT_VOLTAGE : 0);
    const double d = real(c.d.integral_q20, 20) + 150.0, q = real(c.q.integral_q20, 20) - 250.0;
    if (closed) {
      EXPECT_GT(d, 1.0);
      // a quarter of the bandwidth is both axes' corner: what comes off has the direction of the command
      EXPECT_NEAR(q / d, -250.0 / 150.0, 0.1);
    } else {
      EXPECT_EQ(d, 0.0);
      EXPECT_EQ(q, 0.0);
    }
  }
}

// What a person asked for; else what the source wants. A start and a commissioning live on opposite vectors.
TEST_F(Modulation, TheExcitationIsTheOneAskedForOrTheSources) {
  for (std::int32_t source = POSITION_ENCODER; source <= POSITION_FLUX_ACTIVE; ++source) {
    if (!has_source(source)) continue;
    for (const bool fast : {false, true}) {
      for (const bool alone : {false, true}) {
        SetUp();
        use_source(source);
        // the paper's own: long zero vectors up to three quarters of the blend's begin, and in this period beyond
        const std::int32_t enter = inside::config().blend.low_bpp / 4 * 3;
        inside::selected().speed_bpp = fast ? -enter : 1 - enter;
        inside::blend_region() = alone ? BLEND_HIGH : BLEND_BOTH;
        inside::blend_share_q15() = 0;
        const bool pair = source == POSITION_OBSERVER;  // it has two windows
        excitation_t wanted = pair ? EXCITATION_CHEAPEST : EXCITATION_ALTERNATING;
        if (source == POSITION_PAPER) wanted = fast && alone ? EXCITATION_EXTENDED : EXCITATION_LONG_ZERO;
        if (source >= POSITION_FLUX_CONV && alone) wanted = EXCITATION_CENTRED;
        EXPECT_TRUE(modulates_as(wanted)) << source << fast << alone;
      }
    }
  }
}

TEST_F(Modulation, AStartAndACommissioningLiveOnOppositeVectors) {
  for (const std::int32_t asked : {0, 1, 2, 4}) {
    for (const drive_state_t state : {DRIVE_RUN, DRIVE_STOP, DRIVE_START, DRIVE_COMMISSION}) {
      SetUp();
      parameters.excitation = asked;
      use_parameters();
      inside::be_in(state);
      inside::is_shorted() = false;
      const bool own = state == DRIVE_START || state == DRIVE_COMMISSION;
      EXPECT_TRUE(modulates_as(own ? EXCITATION_CHEAPEST : static_cast<excitation_t>(asked))) << asked << state;
    }
  }
}

// Whatever voltage is asked: all lower devices on for the whole period, which three windows share.
TEST_F(Modulation, AShortedMachineHasAPatternOfItsOwn) {
  inside::is_shorted() = true;
  inside::modulate_step();
  const sampling_config_t& c = inside::config().modulator.sampling;
  const svpwm_pattern_t& p = inside::running_pattern();
  ASSERT_EQ(p.window_count, 3);
  int at = 0;
  for (int k = 0; k < p.window_count; ++k) {
    const svpwm_window_t& w = p.windows[k];
    EXPECT_EQ(w.start, at + c.settle_ticks);
    EXPECT_EQ(w.state, 0);
    at += 3300;
    EXPECT_EQ(w.end, std::min<int>(at - c.burst_ticks, c.last_tick));
  }
  EXPECT_GE(p.windows[2].end, 6600 + c.settle_ticks + c.span_min_ticks);
  for (const std::int16_t edge : p.pulses.at) {
    EXPECT_LT(edge, 0) << "a leg is never high";
  }
  for (int leg = 0; leg < 3; ++leg) EXPECT_EQ(board.frame.edge_tick[leg], static_cast<std::uint16_t>(p.pulses.at[leg]));
  EXPECT_EQ(board.frame.burst_start_tick[0], p.windows[0].start);
}

TEST_F(Modulation, OnlyAStartShortsTheMachine) {
  inside::is_shorted() = true;
  drive_enter(&drive, DRIVE_RUN);
  inside::modulate_step();
  const auto& at = inside::running_pattern().pulses.at;
  EXPECT_GE(*std::max_element(std::begin(at), std::end(at)), 0);
}

// An open loop commands nothing, and begins anew.
TEST_F(Modulation, AnOpenLoopCommandsNoVoltageAndForgets) {
  inside::loop_is_closed() = false;
  inside::current_controller().d.integral_q20 = inside::current_controller().q.integral_q20 = 99999;
  inside::current_step();
  EXPECT_EQ(inside::command_dq_q16().d, 0);
  EXPECT_EQ(inside::command_dq_q16().q, 0);
  EXPECT_EQ(inside::current_controller().d.integral_q20, 0);
  EXPECT_EQ(inside::current_controller().q.integral_q20, 0);
}

TEST_F(Modulation, WithADividerOfTwoTheCommandStandsStillInEverySecondPeriod) {
  for (const std::int32_t divider : {1, 2}) {
    for (std::uint16_t period = 0; period < 10; ++period) {
      SetUp();
      parameters.current_divider = divider;
      use_parameters();
      inside::scheduled_period() = period;
      inside::reference_dq_q20() = raw_dq({2.0, 5.0}, 20);
      current_controller_t copy = inside::current_controller();
      const dq_t before = inside::command_dq_q16();
      const dq_t wanted =
          current_controller_step(&copy, &inside::config().current, &inside::model(), inside::reference_dq_q20(),
                                  inside::current_dq_q20(), inside::selected().speed_bpp);
      inside::current_step();
      const bool steps = divider == 1 || period % 2 == 0;
      EXPECT_EQ(inside::command_dq_q16().d, steps ? wanted.d : before.d) << divider << period;
      EXPECT_EQ(inside::command_dq_q16().q, steps ? wanted.q : before.q) << divider << period;
    }
  }
}

// A change of the reference that is known beforehand is fed along q, within what a command may be.
TEST_F(Modulation, WhatIsFedComesOnTopAlongQ) {
  const auto command = [](std::int32_t feed_forward_q16) {
    inside::scheduled_period() = 0;
    current_controller_reset(&inside::current_controller());
    inside::feed_forward_q16() = feed_forward_q16;
    inside::current_step();
    return inside::command_dq_q16();
  };
  const dq_t without = command(0);
  for (const double volts : {12.0, -7.0}) {
    const dq_t with = command(raw(volts, 16));
    EXPECT_EQ(with.d, without.d);
    EXPECT_EQ(with.q - without.q, raw(volts, 16));
  }
  EXPECT_EQ(command(INT32_MAX).q, CURRENT_COMMAND_END_Q16);
  EXPECT_EQ(command(INT32_MIN).q, -CURRENT_COMMAND_END_Q16);
}

}  // namespace

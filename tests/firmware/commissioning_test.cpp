// The command: where it may be given, how it is broken off, and what becomes of the parameters then.

#include <cstring>

#include "hal/hal_replay.h"
#include "sim_host/bench/texts.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/commissioning/result.h"
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/mode.h"
#include "firmware/mode/states.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
#include "firmware/text/catalogue.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

class Commissioning : public Drive {
 protected:
  void SetUp() override {
    NEEDS("commissioning");
    Drive::SetUp();
  }
  /// In the start; its end is told to the drive, for it needs a machine behind it.
  void begin() {
    parameters.flying_start = 0;
    use_parameters();
    make_ready();
    drive_command_commission();
    periods(10);
    ASSERT_EQ(inside::state(), DRIVE_START);
    start_run(&drive, 0, 0);
    periods(5);
  }
};

TEST_F(Commissioning, FollowsTheStart) {
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_NONE);
  begin();
  EXPECT_EQ(inside::state(), DRIVE_COMMISSION);
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_RUNNING);
  EXPECT_EQ(drive_commissioning_phase(), COMMISSIONING_ALIGN);
  EXPECT_TRUE(board.gates_on);
  EXPECT_EQ(parameter_set(2, parameter_get(2)), SET_RUNNING) << "no stopped parameter under way";
}

TEST_F(Commissioning, IsTakenInReadyOnly) {
  make_run();
  const std::int16_t settle = inside::config().modulator.sampling.settle_ticks;
  drive_command_commission();
  EXPECT_GT(inside::config().modulator.sampling.settle_ticks, settle);
  periods(20);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_NONE);
  background_step(&drive);
  EXPECT_EQ(inside::config().modulator.sampling.settle_ticks, settle) << "nor does a run keep what it asked for";
}

// It needs the angle of a shaft that stands, whichever way a start would have taken.
TEST_F(Commissioning, IsNotTurnedByAVector) {
  for (const bool asked : {true, false}) {
    SetUp();
    parameters.start_method = 1;
    parameters.flying_start = 0;
    use_parameters();
    make_ready();
    asked ? drive_command_commission() : drive_command_start();
    periods(2);
    EXPECT_EQ(inside::start_phase(), asked ? START_AXIS : START_IF_RAMP);
  }
}

// Nor are the wires looked at first where nobody has listened whether the shaft turns.
TEST_F(Commissioning, AStartByAVectorLooksAtTheWiresOnlyBehindAListening) {
  for (const bool listens : {true, false}) {
    SetUp();
    parameters.start_method = 1;
    parameters.flying_start = listens;
    parameters.wiring_check = 1;
    use_parameters();
    make_ready();
    drive_command_start();
    period();
    ASSERT_EQ(inside::start_phase(), listens ? START_LISTEN : START_IF_RAMP);
    EXPECT_EQ(start_at_standstill(&drive), listens ? START_AXIS : START_IF_RAMP);
  }
}

// What shows no axis is measured as it stands; a start of the same machine goes on as it did.
TEST_F(Commissioning, AMachineWithoutSaliencyIsNotAskedForItsPolarity) {
  for (const bool asked : {true, false}) {
    for (const double saliency : {0.05, 0.08}) {
      SetUp();
      parameters.flying_start = 0;
      use_parameters();
      make_ready();
      asked ? drive_command_commission() : drive_command_start();
      periods(3);
      ASSERT_EQ(inside::start_phase(), START_AXIS);
      const machine_model_t& m = inside::model();
      axis_t& seen = starting.axis;
      seen = {1 << 20, 0, 0, 0, 0, AXIS_PERIODS};
      const double mean = real(m.yd_q30, 30) / 2 + real(m.yq_q30, 30) / 2;
      const double half = (real(m.yd_q30, 30) - real(m.yq_q30, 30)) / 2;
      seen.mirror_q16 = raw((saliency * mean - half) * 4096.0, 16);
      inside::is_exclusive() = true;
      starting.tick = 10;
      const start_phase_t next = axis_phase.step(&drive);
      const bool at_once = asked && saliency < 1.0 / 16.0;
      EXPECT_EQ(next, at_once ? START_GOES_ON : START_SETTLE) << asked << saliency;
      EXPECT_EQ(inside::state(), at_once ? DRIVE_COMMISSION : DRIVE_START) << asked << saliency;
      EXPECT_EQ(inside::start_found().uniform, saliency < 1.0 / 16.0);
      if (!at_once) continue;
      periods(3);
      EXPECT_TRUE(commissioning.uniform);
      EXPECT_EQ(drive_known(&drive) & KNOWN_ROTOR, 0);
      EXPECT_TRUE(inside::loop_is_closed());
    }
  }
}

TEST_F(Commissioning, AStartIsStillAStart) {
  begin();
  drive_command_stop();
  periods(5);
  inside::withdraw_reload();  // the background level's part
  drive_command_start();
  periods(10);
  start_run(&drive, 0, 0);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

TEST_F(Commissioning, AShaftThatTurnsIsBroughtToRestInstead) {
  parameters.flying_start = 0;
  use_parameters();
  make_ready();
  drive_command_commission();
  periods(10);
  inside::is_caught() = true;
  start_run(&drive, 0, 4000000);  // 140 rpm
  EXPECT_EQ(inside::state(), DRIVE_STOP);
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_ABORTED);
}

TEST_F(Commissioning, AStopBreaksItOffAndChangesNothing) {
  begin();
  const parameters_t before = parameters;
  const std::int16_t settle = inside::config().modulator.sampling.settle_ticks;
  drive_command_stop();
  periods(3);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_ABORTED);
  EXPECT_EQ(std::memcmp(&before, &parameters, sizeof before), 0);
  background_step(&drive);
  EXPECT_LT(inside::config().modulator.sampling.settle_ticks, settle);
}

TEST_F(Commissioning, AFaultEndsIt) {
  begin();
  board.pin_low = true;
  board.tripped_by_pin = true;
  periods(2);
  commissioning_service(&drive);
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_FAILED);
  EXPECT_EQ(drive_commissioning_phase(), COMMISSIONING_IDLE);
  EXPECT_EQ(inside::state_behind(), DRIVE_BOOT) << "no start leads there any more";
  EXPECT_TRUE(inside::reload_requested());
  EXPECT_FALSE(board.gates_on);
}

TEST_F(Commissioning, SumsThatAreEmptyChangeNothing) {
  commissioning_report_t report;
  const parameters_t before = parameters;
  commissioning.model = inside::config().nameplate;
  commissioning_judge(&commissioning, &report);
  EXPECT_EQ(commissioning_use(&report), COMMISSIONING_PARTLY);
  EXPECT_EQ(report.count, 24);
  for (int k = 0; k < report.count; ++k) {
    const commissioning_result_t& r = report.list[k];
    EXPECT_TRUE(r.verdict != VERDICT_USED || r.value == r.before) << r.id;
  }
  EXPECT_EQ(std::memcmp(&before, &parameters, sizeof before), 0);
}

// At no current the machine is as the model has it, at the levels nothing came in.
TEST_F(Commissioning, AMapCurrentWithoutItsLevelsIsNotUsed) {
  commissioning_report_t report;
  commissioning_t& c = commissioning;
  parameters.current_limit = raw(8.0, 20);
  use_parameters();
  const std::int32_t before = parameters.map_current;
  c.model = inside::config().nameplate;
  c.unsaturated.vv_dd = c.unsaturated.vv_qq = 1 << 30;
  c.unsaturated.count = 100;
  commissioning_judge(&c, &report);
  EXPECT_EQ(commissioning_use(&report), COMMISSIONING_PARTLY);
  EXPECT_EQ(parameters.map_current, before);
  EXPECT_EQ(parameters.map_known, 0);
}

TEST_F(Commissioning, ItsEndRestoresTheConfigurationWhateverWasFound) {
  begin();
  commissioning.phase = COMMISSIONING_EVALUATE;
  commissioning.evaluate = true;
  inside::withdraw_reload();
  commissioning.model = inside::config().nameplate;
  commissioning_service(&drive);
  EXPECT_TRUE(inside::reload_requested()) << "nothing was measured, yet the longer settling has to go";
}

// Played from a recording, the background's work is done where it was done, and not before.
TEST_F(Commissioning, ARecordingDecidesWhenTheBackgroundWorks) {
  begin();
  commissioning.phase = COMMISSIONING_EVALUATE;
  commissioning.evaluate = true;
  inside::is_over() = true;
  commissioning.model = inside::config().nameplate;
  drive_parameters_changed();
  hal_replay_start(REPLAY_PLAYS, nullptr);
  background_step(&drive);
  EXPECT_TRUE(commissioning.evaluate);
  EXPECT_TRUE(inside::reload_requested());
  hal_replay_start(REPLAY_OFF, nullptr);
  background_step(&drive);
  EXPECT_FALSE(commissioning.evaluate);
  EXPECT_FALSE(inside::reload_requested());
}

// Whatever the last one was broken off in.
TEST_F(Commissioning, BeginsWithNothingOfTheLastOne) {
  parameters.flying_start = 0;
  use_parameters();
  make_ready();
  commissioning_t& c = commissioning;
  c.predicting = c.solve_motion = c.evaluate = c.uniform = true;
  c.phase = COMMISSIONING_SPIN;
  c.tick = 99;
  drive_command_commission();
  period();
  EXPECT_EQ(inside::state(), DRIVE_START);
  EXPECT_FALSE(inside::spins() || inside::is_frozen() || c.predicting || c.solve_motion || c.evaluate);
  EXPECT_FALSE(c.uniform);
  EXPECT_EQ(inside::state_behind(), DRIVE_COMMISSION);
  EXPECT_EQ(c.phase, COMMISSIONING_IDLE);
  EXPECT_EQ(c.tick, 0);
}

// Phase by phase; the model follows the windows while the shaft is turned to its place, and the gates are off at the
// end.
TEST_F(Commissioning, PhasesFollowEachOther) {
  begin();
  commissioning_t& c = commissioning;
  EXPECT_FALSE(inside::is_frozen());
  c.tick = 6000;  // of turning to its place
  commissioning_state.step(&drive);
  EXPECT_EQ(c.phase, COMMISSIONING_ALIGN) << "the end has a period of its own";
  inside::is_exclusive() = true;
  commissioning_state.step(&drive);
  EXPECT_EQ(c.phase, COMMISSIONING_STAIRCASE);
  EXPECT_EQ(c.tick, 0);
  EXPECT_TRUE(inside::is_frozen());
  commissioning_state.step(&drive);
  EXPECT_EQ(c.tick, 1);
  c.staircase.index = STAIRCASE_LEVELS;
  c.staircase.tick = 601;
  inside::reference_dq_q20().d = 0;
  commissioning_state.step(&drive);
  EXPECT_EQ(c.phase, COMMISSIONING_SPIN);
  c.tick = 2;
  c.spin.begun = true;
  inside::sensor_trim().mismatch_q30 = 4321;
  commissioning_state.step(&drive);  // a spin that is over
  EXPECT_EQ(c.phase, COMMISSIONING_MAP);
  EXPECT_EQ(c.mismatch_q30, 4321);
  c.tick = 1;
  c.map.level = MAP_LEVELS;
  c.map.pause = true;
  c.map.tick = 1000;
  c.map.train = 1;
  commissioning_state.step(&drive);
  EXPECT_EQ(c.phase, COMMISSIONING_EVALUATE);
  EXPECT_TRUE(c.evaluate);
  EXPECT_TRUE(inside::is_over());
  EXPECT_FALSE(board.gates_on);
  EXPECT_FALSE(inside::loop_is_closed());
  EXPECT_EQ(inside::state(), DRIVE_COMMISSION);
  commissioning_state.step(&drive);
  EXPECT_EQ(inside::state(), DRIVE_COMMISSION) << "the background level is not through yet";
  c.evaluate = false;
  commissioning_state.step(&drive);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

TEST_F(Commissioning, AStopDuringTheEvaluationIsTooLate) {
  begin();
  commissioning.phase = COMMISSIONING_EVALUATE;
  commissioning.evaluate = true;
  inside::is_over() = true;
  drive_command_stop();
  periods(3);
  EXPECT_EQ(inside::state(), DRIVE_COMMISSION);
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_RUNNING);
}

TEST_F(Commissioning, ASpeedCommandDoesNotReachTheSpin) {
  begin();
  inside::spins() = true;
  inside::target_bpp() = 12345;
  drive_command_speed(1000L * 65536L);
  drive_sequence(&drive);
  EXPECT_EQ(inside::command_rpm_q16(), 1000L * 65536L) << "it is for what follows";
  EXPECT_EQ(inside::target_bpp(), 12345);
  inside::spins() = false;
  drive_command_speed(1000L * 65536L);
  drive_sequence(&drive);
  EXPECT_GT(inside::target_bpp(), 12345);
}

TEST_F(Commissioning, EveryVerdictAndPhaseHasWords) {
  for (int k = VERDICT_USED; k <= VERDICT_DEPENDS; ++k) {
    EXPECT_GT(bench::words_of(CATALOGUE_VERDICT, static_cast<std::uint16_t>(k)).size(), 10u);
  }
  for (int k = COMMISSIONING_IDLE; k <= COMMISSIONING_COOLING; ++k) {
    EXPECT_GT(bench::words_of(CATALOGUE_PHASE, static_cast<std::uint16_t>(k)).size(), 5u);
  }
}

// Nothing of the last commissioning is in a sum when its first period is added.
TEST_F(Commissioning, EachPhaseBeginsWithoutSums) {
  begin();
  commissioning_t& c = commissioning;
  const auto first_period = [&](bool (*phase)(drive_t*)) {
    std::memset(&c.staircase, 0x11, sizeof c.staircase);
    std::memset(&c.map, 0x11, sizeof c.map);
    std::memset(&c.spin, 0x11, sizeof c.spin);
    std::memset(&c.unsaturated, 0x11, sizeof c.unsaturated);
    c.tick = 0;
    inside::spins() = false;
    inside::is_frozen() = true;
    inside::window_count() = 0;
    EXPECT_FALSE(phase(&drive));
  };
  first_period(commissioning_climb);
  EXPECT_EQ(c.staircase.index, 0);
  EXPECT_EQ(c.staircase.tick, 0);
  for (const staircase_level_t& l : c.staircase.level) {
    c.staircase.index = static_cast<std::uint16_t>(&l - c.staircase.level);
    c.staircase.tick = 0;
    c.tick = 1;
    EXPECT_FALSE(commissioning_climb(&drive));
    EXPECT_EQ(l.current | l.factor | l.command | l.residual | l.sag, 0);
    EXPECT_EQ(l.periods | l.windows, 0);
  }
  first_period(commissioning_map);
  EXPECT_EQ(c.map.level, 0);
  EXPECT_EQ(c.map.train, 0);
  EXPECT_EQ(c.map.tick, 1);
  EXPECT_TRUE(c.map.pause);
  EXPECT_EQ(c.unsaturated.count, 0);
  const double moved = rad(angle_diff_bam(c.target_bam, inside::selected().angle_bam));
  EXPECT_NEAR(moved, 45.0 * kDegree / 300.0, 1e-6) << "from where the shaft is";
  for (c.tick = 1; c.map.tick < 300; ++c.tick) EXPECT_FALSE(commissioning_map(&drive));
  EXPECT_TRUE(c.map.pause) << "well before the first train";
  for (const auto& level : c.map.group) {
    for (const map_group_t& g : level) {
      EXPECT_EQ(g.position | g.current, 0);
      EXPECT_EQ(g.tensor.count, 0);
    }
  }
  first_period(commissioning_spin);
  c.tick = 1;
  inside::is_exclusive() = true;
  EXPECT_FALSE(commissioning_spin(&drive));
  EXPECT_TRUE(inside::spins() && !inside::is_frozen());
  EXPECT_EQ(c.spin.leg, 0);
  EXPECT_EQ(c.spin.tick, 0);
  for (const spin_sums_t& s : c.spin.station) EXPECT_EQ(s.speed | s.voltage_q | s.current_q | s.periods, 0);
  for (const spin_sums_t& r : c.spin.ramp) EXPECT_EQ(r.speed | r.current_q | r.periods, 0);
}

}  // namespace

// What the drivers put in the recording and take from it: each call's words, in the order in which hal_replay.h has
// them.

#include <functional>

#include "hal/f2808/registers.h"
#include "hal/hal_adc.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_encoder.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"
#include "hal/hal_safety.h"
#include "hal/hal_sampling_timer.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

namespace {

using Words = std::vector<std::uint16_t>;

constexpr std::uint32_t kGateEnable = 1u << 2;  // GPIO34 in port B

struct Call {
  const char* name;
  std::function<std::uint32_t()> act;
  Words told;      // to the HAL
  Words returned;  // by it, from the registers of SetUp
  Words played = {};
  bool hooked = true;              // interrupts may come in it
  bool reaches_registers = false;  // also while the recording is played
};

std::uint32_t as_word(const Words& words) {
  return words.empty() ? 0u : words[0] | (words.size() > 1 ? static_cast<std::uint32_t>(words[1]) << 16 : 0u);
}

template <class F>
std::function<std::uint32_t()> quiet(F f) {
  return [f] {
    f();
    return 0u;
  };
}

const hal_pwm_frame_t kFrame = {{101, 201, 301, 1101, 1201, 1301}, {401, 501, 601}, {1401, 1501, 1601}};

Words frame_by(std::uint16_t deadline) {
  return {REPLAY_FRAME, 101, 1101, 201, 1201, 301, 1301, 401, 1401, 501, 1501, 601, 1601, deadline};
}

const Call kCalls[] = {
    {"hal_pwm_write", [] { return hal_pwm_write(&kFrame, 9000); }, frame_by(9000), {1}, {0}},
    {"hal_pwm_write, late", [] { return hal_pwm_write(&kFrame, 1233); }, frame_by(1233), {0}, {1}},
    {"hal_pwm_set_dead_band", [] { return hal_pwm_set_dead_band(300); }, {REPLAY_DEAD_BAND, 300}, {1}, {0}, false},
    {"hal_pwm_set_dead_band, none", [] { return hal_pwm_set_dead_band(0); }, {REPLAY_DEAD_BAND, 0}, {0}, {1}, false},
    {"hal_pwm_is_tripped", [] { return hal_pwm_is_tripped(); }, {}, {1}, {0}},
    {"hal_pwm_was_tripped_by_pin", [] { return hal_pwm_was_tripped_by_pin(); }, {}, {0}, {1}},
    {"hal_pwm_gates_on", [] { return hal_pwm_gates_on(); }, {REPLAY_GATES_ON}, {1}, {0}},
    {"hal_pwm_is_tripped, now that they are on", [] { return hal_pwm_is_tripped(); }, {}, {0}, {1}},
    {"hal_pwm_gates_off", quiet(hal_pwm_gates_off), {REPLAY_GATES_OFF}, {}, {}, true, true},
    {"hal_pwm_period_tick", [] { return hal_pwm_period_tick(); }, {}, {1234}, {77}},
    {"hal_encoder_count", hal_encoder_count, {}, {0x0ABC, 0x0012}, {0x4321, 0x0765}},
    {"hal_digital_io_emergency", [] { return hal_digital_io_emergency(); }, {}, {1}, {0}},
    {"hal_irq_unexpected_count", [] { return hal_irq_unexpected_count(); }, {}, {1}, {9}},
    {"hal_irq_disable", [] { return hal_irq_disable(); }, {}, {}, {}, true, true},
    {"hal_irq_restore", quiet([] { hal_irq_restore(0); }), {}, {}, {}, true, true},
    {"hal_profile_step", quiet([] { hal_profile_step(5); }), {}, {}, {}, false},
    {"hal_safety_toggle_enable", quiet(hal_safety_toggle_enable), {REPLAY_ENABLE}, {}},
    {"hal_safety_fault_lamp, lit", quiet([] { hal_safety_fault_lamp(true); }), {REPLAY_LAMP, 1}, {}, {}, true, true},
    {"hal_safety_fault_lamp, dark", quiet([] { hal_safety_fault_lamp(false); }), {REPLAY_LAMP, 0}, {}, {}, true, true},
    {"hal_sampling_timer_begin",
     [] { return hal_sampling_timer_begin(1000); },
     {REPLAY_SAMPLING_TIMER, 1000},
     {1},
     {0}},
    {"hal_sampling_timer_begin, too short",
     [] { return hal_sampling_timer_begin(400); },
     {REPLAY_SAMPLING_TIMER, 400},
     {0},
     {1}},
    {"hal_sampling_timer_set_legs", quiet([] { hal_sampling_timer_set_legs(5); }), {REPLAY_LEGS, 5}, {}, {}, false},
    {"hal_sampling_timer_end", quiet(hal_sampling_timer_end), {REPLAY_SAMPLING_TIMER, 0}, {}},
};

}  // namespace

class ReplayOfDrivers : public BusTest {
 protected:
  void SetUp() override {
    bus.power_all();
    hal_irq_install([] {}, [] {});
    bus.vectors[0]();  // unexpected, which trips the gates, too
    bus.words[EPWM_BASE(1) + EPWM_TBCTR] = 1234;
    bus.words[EQEP_BASE(1) + EQEP_QPOSCNT] = 0x0ABC;
    bus.words[EQEP_BASE(1) + EQEP_QPOSCNT + 1] = 0x0012;
    bus.words[REG_GPADAT] = static_cast<std::uint16_t>(~(1u << 13));  // the emergency stop is pressed
    for (std::uint16_t n = 0; n < 16; ++n) bus.words[REG_MIRROR_ADCRESULT0 + n] = static_cast<std::uint16_t>(100 + n);
    bus.words[REG_REVID] = 3;
    hal_adc_set_up();
  }
  void TearDown() override {
    hal_replay_start(REPLAY_OFF, nullptr);
    BusTest::TearDown();
  }

  static void start(replay_mode_t mode) {
    hal_replay_start(mode, [] {});
    hal_replay_step_begin();
  }
  static Words inputs() { return {hal_replay_period.inputs, hal_replay_period.inputs + hal_replay_period.input_count}; }
  static Words outputs() {
    return {hal_replay_period.outputs, hal_replay_period.outputs + hal_replay_period.output_count};
  }
};

TEST_F(ReplayOfDrivers, each_call_is_noted_with_what_it_was_told_and_has_returned) {
  for (const Call& call : kCalls) {
    start(REPLAY_RECORDS);
    const std::uint32_t result = call.act();
    if (!call.returned.empty()) {
      EXPECT_EQ(result, as_word(call.returned)) << call.name;
    }
    EXPECT_EQ(inputs(), call.returned) << call.name;
    EXPECT_EQ(outputs(), call.told) << call.name;
    EXPECT_EQ(hal_replay.call, call.hooked ? 1 : 0) << call.name;
    EXPECT_FALSE(hal_replay.torn) << call.name;
  }
}

TEST_F(ReplayOfDrivers, each_call_is_played_without_its_registers) {
  for (const Call& call : kCalls) {
    start(REPLAY_PLAYS);
    hal_replay_period.input_count = static_cast<std::uint16_t>(call.played.size());
    std::copy(call.played.begin(), call.played.end(), hal_replay_period.inputs);
    bus.forget_steps();
    const std::uint32_t result = call.act();
    if (!call.played.empty()) {
      EXPECT_EQ(result, as_word(call.played)) << call.name;
    }
    EXPECT_EQ(hal_replay.input, call.played.size()) << call.name;
    EXPECT_EQ(outputs(), call.told) << call.name << ": noted again, to be compared";
    EXPECT_EQ(hal_replay.call, call.hooked ? 1 : 0) << call.name;
    EXPECT_EQ(bus.steps.empty(), !call.reaches_registers) << call.name;
    EXPECT_FALSE(hal_replay.torn) << call.name;
  }
}

TEST_F(ReplayOfDrivers, nothing_is_noted_without_a_recording) {
  start(REPLAY_OFF);
  for (const Call& call : kCalls) {
    const std::uint32_t result = call.act();
    if (!call.returned.empty()) {
      EXPECT_EQ(result, as_word(call.returned)) << call.name;
    }
  }
  hal_adc_window_t window;
  hal_adc_read_window(&window);
  hal_timed_samples_t slice;
  hal_sampling_timer_read(&slice);
  EXPECT_EQ(hal_replay.call, 0);
  EXPECT_EQ(inputs(), Words{});
  EXPECT_EQ(outputs(), Words{});
  EXPECT_EQ(hal_replay_period.window_count, 0);
}

// Switching off is never wrong, and the lamp may tell what the drive in the simulation does.
TEST_F(ReplayOfDrivers, gates_go_off_and_the_lamp_follows_while_it_plays) {
  ASSERT_TRUE(hal_pwm_gates_on());
  start(REPLAY_PLAYS);
  hal_pwm_gates_off();
  hal_safety_fault_lamp(true);
  EXPECT_EQ(bus.word32(REG_GPASET), 1u << 27);
  hal_safety_toggle_enable();
  EXPECT_EQ(bus.word32(REG_GPBTOGGLE) & kGateEnable, 0u) << "the gates of the board stay off";
  hal_replay_start(REPLAY_OFF, nullptr);
  EXPECT_TRUE(hal_pwm_is_tripped());
}

TEST_F(ReplayOfDrivers, a_window_has_its_six_results_in_the_order_of_its_members) {
  start(REPLAY_RECORDS);
  hal_adc_window_t was;
  hal_adc_read_window(&was);
  ASSERT_EQ(hal_replay_period.window_count, 1);
  const replay_window_t noted = hal_replay_period.windows[0];
  EXPECT_EQ(Words(noted.results, noted.results + REPLAY_RESULTS),
            (Words{was.start_a, was.start_b, was.end_a, was.end_b, was.link, was.aux}));

  start(REPLAY_PLAYS);
  hal_replay_period.window_count = 1;
  hal_replay_period.windows[0] = {0, {1, 2, 3, 4, 5, 6}};
  bus.forget_steps();
  hal_adc_window_t is;
  hal_adc_read_window(&is);
  EXPECT_EQ((Words{is.start_a, is.start_b, is.end_a, is.end_b, is.link, is.aux}), (Words{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(bus.steps.empty());
  EXPECT_EQ(hal_replay.window, 1);
}

TEST_F(ReplayOfDrivers, a_slice_has_its_three_results) {
  start(REPLAY_RECORDS);
  hal_timed_samples_t was;
  hal_sampling_timer_read(&was);
  EXPECT_EQ((Words{was.current_a, was.current_b, was.link}), (Words{108, 109, 110})) << "sequencer 2 took them";
  ASSERT_EQ(hal_replay_period.window_count, 1);
  const replay_window_t noted = hal_replay_period.windows[0];
  EXPECT_EQ(Words(noted.results, noted.results + REPLAY_RESULTS), (Words{108, 109, 110, 0, 0, 0}));

  start(REPLAY_PLAYS);
  hal_replay_period.window_count = 1;
  hal_replay_period.windows[0] = {0, {1, 2, 3}};
  bus.forget_steps();
  hal_timed_samples_t is;
  hal_sampling_timer_read(&is);
  EXPECT_EQ((Words{is.current_a, is.current_b, is.link}), (Words{1, 2, 3}));
  EXPECT_TRUE(bus.steps.empty());
}

}  // namespace stillspin::test

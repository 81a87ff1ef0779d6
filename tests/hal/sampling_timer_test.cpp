// Slices on a register bus: what is taken from the pulses and windows, what is refused, and what is given back.

#include "hal/f2808/registers.h"
#include "hal/hal_pwm.h"
#include "hal/hal_sampling_timer.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

class Slices : public BusTest {
 protected:
  void SetUp() override {
    bus.power_all();
    ASSERT_TRUE(hal_pwm_init(200));
    bus.ier = 0x0005;
    bus.forget_steps();
  }
  using Values = std::vector<std::uint32_t>;
  std::uint16_t epwm(unsigned module, std::uint32_t offset) { return bus.words[EPWM_BASE(module) + offset]; }
  Values written(unsigned module, std::uint32_t offset) const { return bus.written(EPWM_BASE(module) + offset); }
  /// A compare value now and in the shadow: what was meant for this period must not come any more.
  void expect_at_once(unsigned module, unsigned a, unsigned b) {
    const std::uint32_t base = EPWM_BASE(module);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> course;
    for (const Step& s : bus.steps) {
      const std::uint32_t offset = s.address - base;
      const bool compares = offset == EPWM_CMPCTL || offset == EPWM_CMPA_CMPA || offset == EPWM_CMPB;
      if (s.op == Op::kWrite && compares) course.emplace_back(offset, s.value);
    }
    ASSERT_GE(course.size(), 6u) << "ePWM" << module;
    const decltype(course) expected = {{EPWM_CMPCTL, 0x50}, {EPWM_CMPA_CMPA, a}, {EPWM_CMPB, b},
                                       {EPWM_CMPCTL, 0x00}, {EPWM_CMPA_CMPA, a}, {EPWM_CMPB, b}};
    EXPECT_EQ(decltype(course)(course.end() - 6, course.end()), expected) << "ePWM" << module;
  }
  void expect_held_off() {
    EXPECT_EQ(bus.steps.front().op, Op::kWriteIer);
    EXPECT_EQ(bus.steps.front().value, 0u);
    EXPECT_EQ(bus.steps.back().op, Op::kWriteIer);
    EXPECT_EQ(bus.ier, 0x0005);
  }
};

TEST_F(Slices, begin_stops_bursts_and_holds_the_legs_low) {
  ASSERT_TRUE(hal_sampling_timer_begin(1000));
  expect_at_once(5, 0xFFFF, 0xFFFF);
  expect_at_once(6, 0xFFFF, 0xFFFF);
  expect_at_once(4, 0xFFFF, 10);
  EXPECT_EQ(written(4, EPWM_CMPB).front(), 0xFFFFu) << "the window's burst is off before its counter is the slices'";
  for (unsigned leg = 1; leg <= 3; ++leg) {
    EXPECT_EQ(written(leg, EPWM_AQSFRC), Values{EPWM_AQSFRC_RLDCSF_MASK}) << "without a shadow";
    EXPECT_EQ(written(leg, EPWM_AQCSFRC), Values{1}) << "low";
    expect_before(bus.first_write(EPWM_BASE(leg) + EPWM_AQSFRC), bus.first_write(EPWM_BASE(leg) + EPWM_AQCSFRC),
                  "at once");
    EXPECT_TRUE(written(leg, EPWM_CMPA_CMPA).empty()) << "the forcing is enough";
    EXPECT_EQ(epwm(leg, EPWM_TBPRD), 9999) << "the period goes on";
  }
  for (unsigned module = 4; module <= 6; ++module) {
    EXPECT_TRUE(written(module, EPWM_AQSFRC).empty() && written(module, EPWM_AQCSFRC).empty())
        << "a window has no pins";
  }
  EXPECT_EQ(epwm(4, EPWM_TBPRD), 999);
  EXPECT_EQ(written(4, EPWM_TBCTR), Values{0});
  EXPECT_EQ(epwm(5, EPWM_TBPRD), 9999);
  EXPECT_EQ(bus.words[REG_ADCCHSELSEQ3] & 0xFFu, 0x10u) << "currents, then the link";
  expect_held_off();
}

TEST_F(Slices, refused_ones_change_nothing) {
  for (const std::uint16_t ticks : {0, 1, 400, 499, 501, 700, 9999, 10001, 20000}) {
    EXPECT_FALSE(hal_sampling_timer_begin(ticks)) << ticks;
    EXPECT_TRUE(bus.steps.empty()) << ticks;
  }
  for (const std::uint16_t ticks : {500, 625, 2500, 10000}) EXPECT_TRUE(hal_sampling_timer_begin(ticks)) << ticks;
}

TEST_F(Slices, each_bit_is_a_leg) {
  for (std::uint16_t state = 0; state < 8; ++state) {
    bus.forget_steps();
    hal_sampling_timer_set_legs(state);
    for (unsigned leg = 0; leg < 3; ++leg) {
      EXPECT_EQ(written(1 + leg, EPWM_AQCSFRC), Values{(state >> leg & 1) != 0 ? 2u : 1u}) << state;
    }
    EXPECT_EQ(bus.count_writes(), 3u);
  }
}

TEST_F(Slices, results_are_taken_then_rearmed_then_acknowledged) {
  for (std::uint16_t n = 0; n < 16; ++n) bus.words[REG_MIRROR_ADCRESULT0 + n] = static_cast<std::uint16_t>(100 + n);
  hal_timed_samples_t slice;
  hal_sampling_timer_read(&slice);
  EXPECT_EQ(slice.current_a, 108);
  EXPECT_EQ(slice.current_b, 109);
  EXPECT_EQ(slice.link, 110);
  const std::size_t rearm = bus.first_write(REG_ADCTRL2), clear = bus.first_write(REG_ADCST),
                    acknowledge = bus.first_write(REG_PIEACK);
  expect_before(rearm, clear, "sequencers before the flag");
  expect_before(clear, acknowledge, "flag before PIEACK, or the interrupt would come twice");
  EXPECT_EQ(bus.steps.at(clear).value, 0x0030u);
  EXPECT_EQ(bus.steps.at(acknowledge).value, 0x0001u) << "group 1 and no other";
}

TEST_F(Slices, end_gives_the_period_back_without_pulses_or_bursts) {
  ASSERT_TRUE(hal_sampling_timer_begin(500));
  bus.forget_steps();
  hal_sampling_timer_end();
  for (unsigned module = 1; module <= 6; ++module) expect_at_once(module, 0xFFFF, 0xFFFF);
  EXPECT_EQ(epwm(4, EPWM_TBPRD), 9999);
  for (unsigned leg = 1; leg <= 3; ++leg) {
    EXPECT_EQ(written(leg, EPWM_AQCSFRC), Values{0}) << "its edges count again";
    expect_before(bus.last_write(EPWM_BASE(leg) + EPWM_CMPB), bus.first_write(EPWM_BASE(leg) + EPWM_AQCSFRC),
                  "but none of an old frame's");
  }
  for (unsigned module = 4; module <= 6; ++module) {
    EXPECT_TRUE(written(module, EPWM_AQCSFRC).empty()) << "a window has no pins";
  }
  EXPECT_EQ(bus.words[REG_ADCCHSELSEQ3], 0x1000u);
  EXPECT_EQ(bus.words[REG_ADCMAXCONV], 0x0033u);
  expect_held_off();
}

}  // namespace stillspin::test

#include "hal/f2808/registers.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

namespace {
int control_calls = 0;
int window_calls = 0;
void control() { ++control_calls; }
void window() { ++window_calls; }
constexpr std::uint16_t kGroup1 = 0x0001;
constexpr std::uint16_t kGroup3 = 0x0004;
}  // namespace

class Irq : public BusTest {
 protected:
  void SetUp() override {
    bus.power_all();
    control_calls = 0;
    window_calls = 0;
  }
};

TEST_F(Irq, everything_is_off_before_vectors_change) {
  bus.words[REG_PIECTRL] = PIECTRL_ENPIE_MASK;
  bus.ier = kGroup1 | kGroup3;
  hal_irq_install(control, window);
  const std::size_t first_vector = bus.first(Op::kSetVector);
  expect_before(bus.first(Op::kDisableInterrupts), first_vector, "INTM");
  expect_before(bus.first(Op::kWriteIer), first_vector, "IER");
  expect_before(bus.first_write(REG_PIECTRL), first_vector, "PIE");
  EXPECT_EQ(bus.steps.at(bus.first_write(REG_PIECTRL)).value, 0u);
  expect_before(first_vector, bus.first_write(REG_PIECTRL, PIECTRL_ENPIE_MASK), "table before it is used");
  expect_before(bus.first(Op::kDisableInterrupts), bus.first(Op::kClearIfr), "nothing new behind the one who cleans");
  EXPECT_EQ(bus.ier, 0u);
  for (unsigned group = 1; group <= 12; ++group) {
    EXPECT_EQ(bus.written(REG_PIEIER(group)), std::vector<std::uint32_t>{0}) << "group " << group;
    EXPECT_EQ(bus.written(REG_PIEIFR(group)), std::vector<std::uint32_t>{0}) << "group " << group;
  }
  EXPECT_EQ(bus.first(Op::kEnableInterrupts), FakeBus::npos) << "enabling is another call";
}

TEST_F(Irq, two_vectors_lead_to_the_given_functions) {
  hal_irq_install(control, window);
  ASSERT_EQ(bus.vectors.size(), VECTOR_COUNT);
  bus.vectors[VECTOR_EPWM1_INT]();
  EXPECT_EQ(control_calls, 1);
  EXPECT_EQ(window_calls, 0);
  bus.vectors[VECTOR_SEQ2INT]();
  EXPECT_EQ(window_calls, 1);
  EXPECT_EQ(hal_irq_unexpected_count(), 0u);
}

TEST_F(Irq, every_other_vector_switches_the_gates_off) {
  hal_irq_install(control, window);
  std::uint16_t expected = 0;
  for (std::uint16_t vector = 0; vector < VECTOR_COUNT; ++vector) {
    if (vector == VECTOR_EPWM1_INT || vector == VECTOR_SEQ2INT) {
      continue;
    }
    ASSERT_TRUE(hal_pwm_gates_on());
    bus.vectors[vector]();
    EXPECT_TRUE(hal_pwm_is_tripped()) << "vector " << vector;
    EXPECT_EQ(hal_irq_unexpected_count(), ++expected);
  }
  EXPECT_EQ(control_calls + window_calls, 0);
}

TEST_F(Irq, unexpected_interrupts_are_counted_to_the_end_of_a_word) {
  hal_irq_install(control, window);
  for (unsigned k = 0; k < 65536; ++k) {
    bus.vectors[VECTOR_EPWM1_INT + 1]();
    bus.forget_steps();
  }
  EXPECT_EQ(hal_irq_unexpected_count(), 65535u) << "none is no count to come back to";
  hal_irq_install(control, window);
  EXPECT_EQ(hal_irq_unexpected_count(), 0u) << "since it was installed";
}

TEST_F(Irq, old_events_are_cleared_from_the_peripheral_to_the_cpu) {
  hal_irq_enable();
  const std::uint32_t events = EPWM_BASE(1) + EPWM_ETPS;
  const std::size_t counter_off = bus.first_write(events);
  const std::size_t epwm_flag = bus.first_write(EPWM_BASE(1) + EPWM_ETCLR);
  const std::size_t adc_flag = bus.first_write(REG_ADCST);
  const std::size_t counter_on = bus.first_write(events, 1);
  EXPECT_EQ(bus.steps.at(counter_off).value, 0u);
  expect_before(counter_off, epwm_flag, "event counter before ETFLG, or a waiting event sets it again");
  expect_before(epwm_flag, bus.first_write(REG_PIEIFR(3)), "ETFLG before PIEIFR");
  expect_before(adc_flag, bus.first_write(REG_PIEIFR(1)), "ADCST before PIEIFR");
  for (const unsigned group : {1u, 3u}) {
    const std::size_t held = bus.first_write(REG_PIEIER(group));
    EXPECT_EQ(bus.steps.at(held).value, 0u) << "flags may be written while nothing of the group is enabled";
    EXPECT_EQ(bus.steps.at(bus.first_write(REG_PIEIFR(group))).value, 0u);
    expect_before(held, bus.first_write(REG_PIEIFR(group)), "PIEIER off before PIEIFR");
    expect_before(bus.first_write(REG_PIEIFR(group)), bus.first(Op::kClearIfr), "PIEIFR before IFR");
  }
  EXPECT_EQ(bus.steps.front().op, Op::kDisableInterrupts);
  EXPECT_EQ(bus.steps.at(epwm_flag).value, EPWM_ETCLR_INT_MASK);
  EXPECT_EQ(bus.steps.at(adc_flag).value, ADCST_INT_SEQ1_CLR_MASK | ADCST_INT_SEQ2_CLR_MASK);
  EXPECT_NE(bus.first_write(REG_PIEACK, kGroup1), FakeBus::npos);
  EXPECT_NE(bus.first_write(REG_PIEACK, kGroup3), FakeBus::npos);
  expect_before(bus.first_write(REG_PIEIFR(3)), bus.first_write(REG_PIEIER(3), 1), "PIEIFR before PIEIER");
  expect_before(bus.first_write(REG_PIEIFR(1)), bus.first_write(REG_PIEIER(1), 2), "PIEIFR before PIEIER");
  expect_before(bus.last_write(REG_PIEACK), counter_on, "everything is ready before events count");
  expect_before(counter_on, bus.first(Op::kEnableInterrupts), "INTM last");
  EXPECT_EQ(bus.words[events], 1u) << "every period";
  EXPECT_EQ(bus.words[REG_PIEIER(1)], 0x0002u) << "INT1.2: sequencer 2";
  EXPECT_EQ(bus.words[REG_PIEIER(3)], 0x0001u) << "INT3.1: ePWM1";
  EXPECT_EQ(bus.ier, kGroup1 | kGroup3);
  EXPECT_EQ(bus.steps.back().op, Op::kEnableInterrupts);
}

TEST_F(Irq, only_the_window_interrupt_may_preempt_the_control_interrupt) {
  bus.ier = kGroup1 | kGroup3;
  hal_irq_control_begin();
  ASSERT_EQ(bus.steps.size(), 2u);
  EXPECT_EQ(bus.steps.at(0).op, Op::kWriteIer);
  EXPECT_EQ(bus.steps.at(0).value, kGroup1);
  EXPECT_EQ(bus.steps.at(1).op, Op::kEnableInterrupts);
}

TEST_F(Irq, control_interrupt_ends_with_interrupts_off_flag_then_acknowledge) {
  hal_irq_control_end();
  const std::size_t off = bus.first(Op::kDisableInterrupts);
  const std::size_t flag = bus.first_write(EPWM_BASE(1) + EPWM_ETCLR, EPWM_ETCLR_INT_MASK);
  const std::size_t acknowledge = bus.first_write(REG_PIEACK);
  expect_before(off, flag, "INTM before the flag");
  expect_before(flag, acknowledge, "flag before PIEACK, or the interrupt would come twice");
  EXPECT_EQ(bus.steps.at(acknowledge).value, kGroup3);
  EXPECT_EQ(bus.first(Op::kEnableInterrupts), FakeBus::npos) << "the return does that";
}

TEST_F(Irq, disable_and_restore_nest) {
  bus.ier = kGroup1;
  const std::uint16_t outer = hal_irq_disable();
  const std::uint16_t inner = hal_irq_disable();
  hal_irq_restore(inner);
  EXPECT_EQ(bus.ier, 0u) << "still off";
  hal_irq_restore(outer);
  EXPECT_EQ(bus.ier, kGroup1);
}

}  // namespace stillspin::test

// run_until: exact ends, the same run however it is cut, preemption in elapse and idle, errors and exceptions.

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
std::vector<Tick> trace;
Tick times[8];

class Run : public ::testing::Test {
 protected:
  void start(Chip::Firmware firmware) {
    trace.clear();
    device = std::make_unique<Chip>(world, firmware);
    chip = device.get();
  }
  RecordingWorld world;
  std::unique_ptr<Chip> device;
};

TEST_F(Run, EndsAtTheTickAskedFor) {
  start([] { sleep_for_ever(); });
  EXPECT_EQ(device->now(), 0);
  for (Tick t : {Tick{0}, Tick{1}, Tick{7}, Tick{7}, Tick{99'999}, Tick{100'000}}) {
    device->run_until(t);
    EXPECT_EQ(device->now(), t);
  }
  EXPECT_THROW(device->run_until(99'999), std::invalid_argument);
}

TEST_F(Run, AccessesUpToTheEndAreDoneLaterOnesAreNot) {
  start([] {
    write_protected(REG_GPADIR, 1);             // ends at tick 30
    for (;;) target_write16(REG_GPATOGGLE, 1);  // every 10 ticks
  });
  device->run_until(59);
  EXPECT_EQ(world.pins.size(), 2u);
  device->run_until(60);
  ASSERT_EQ(world.pins.size(), 3u);
  EXPECT_EQ(world.pins[2].t, 60);
}

TEST_F(Run, WorldIsCalledAtItsTicks) {
  world.calls = {0, 3, 17, 17, 1001};
  start([] { sleep_for_ever(); });
  device->run_until(17);
  EXPECT_EQ(world.called, (std::vector<Tick>{0, 3, 17, 17}));
  device->run_until(5000);
  EXPECT_EQ(world.called.back(), 1001);
}

TEST_F(Run, CallMissedByTheHostComesAtOnce) {
  start([] { sleep_for_ever(); });
  device->run_until(500);
  world.calls = {100};
  device->run_until(600);
  EXPECT_EQ(world.called, (std::vector<Tick>{500}));
}

TEST_F(Run, ElapseIsPreemptedAndStillLastsItsTime) {
  start([] {
    start_clock();
    install(VECTOR_TINT0, [] {
      trace.push_back(chip->now());
      target_elapse(50);
      target_write16(REG_PIEACK, group_bit(1));
    });
    enable_pie();
    target_write_ier(group_bit(1));
    target_enable_interrupts();
    target_write32(CPUTIMER_BASE(0) + CPUTIMER_PRD, 999);
    target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TRB_MASK | CPUTIMER_TCR_TIE_MASK);
    times[0] = chip->now();
    target_elapse(5000);
    times[1] = chip->now();
    sleep_for_ever();
  });
  device->run_until(1'000'000);
  ASSERT_GE(trace.size(), 2u);
  EXPECT_EQ(trace[0], times[0] + 999 + 22);
  EXPECT_EQ(trace[1], trace[0] + 1000);
  // 5000 cycles of its own and five interrupts of 22 + 50 + 1 + 16 cycles.
  EXPECT_EQ(times[1] - times[0], 5000 + 5 * 89);
}

TEST_F(Run, IdleSleepsUntilTheInterruptAndIsCounted) {
  start([] {
    start_clock();
    install(VECTOR_TINT0, [] { target_write16(REG_PIEACK, group_bit(1)); });
    enable_pie();
    target_write_ier(group_bit(1));
    target_enable_interrupts();
    target_write32(CPUTIMER_BASE(0) + CPUTIMER_PRD, 999);
    target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TRB_MASK | CPUTIMER_TCR_TIE_MASK);
    times[0] = chip->now();
    target_idle();
    times[1] = chip->now();
    sleep_for_ever();
  });
  device->run_until(1'000'000);
  EXPECT_EQ(times[1] - times[0], 999 + 22 + 1 + 16);
  EXPECT_EQ(device->statistics().idle_ticks, 999 - 1);  // IDLE itself is an instruction
}

TEST_F(Run, IdleWithoutInterruptsSleepsForEver) {
  start([] {
    disable_watchdog();
    target_idle();
  });
  device->run_until(3'000'000'000);
  EXPECT_EQ(device->now(), 3'000'000'000);
  EXPECT_TRUE(device->is_idle());
}

// A firmware with everything: timer and ePWM interrupts, nesting, conversions, pins, a watchdog that bites in the end.
void busy_isr() {
  trace.push_back(chip->now());
  target_write_ier(group_bit(1));
  target_enable_interrupts();
  target_elapse(static_cast<std::uint16_t>(300 + trace.size() % 7));
  target_write32(REG_GPATOGGLE, 1uL << 31);
  target_write16(EPWM_BASE(1) + EPWM_ETCLR, EPWM_ETCLR_INT_MASK);
  target_disable_interrupts();
  target_write16(REG_PIEACK, group_bit(3));
}

void busy_firmware() {
  start_clock();
  write_protected(REG_PCLKCR1, 0x3F);
  target_eallow();
  target_write32(REG_GPAMUX1, 0x00555555);
  target_write32(REG_GPADIR, 1uL << 31);
  target_edis();
  install(VECTOR_TINT0, [] {
    trace.push_back(-chip->now());
    target_write16(REG_PIEACK, group_bit(1));
  });
  install(VECTOR_EPWM1_INT, busy_isr);
  enable_pie();
  target_write_ier(group_bit(1) | group_bit(3));
  for (unsigned n = 1; n <= 3; ++n) {
    target_write16(EPWM_BASE(n) + EPWM_TBPRD, 999);
    target_write16(EPWM_BASE(n) + EPWM_CMPA_CMPA, static_cast<std::uint16_t>(100 * n));
    target_write16(EPWM_BASE(n) + EPWM_AQCTLA, 0x0012);  // set at zero, clear at CMPA
    target_write16(EPWM_BASE(n) + EPWM_TBCTL, 0);
  }
  target_write16(EPWM_BASE(1) + EPWM_ETPS, 1);
  target_write16(EPWM_BASE(1) + EPWM_ETSEL, EPWM_ETSEL_INTEN_MASK | 1);
  target_write32(CPUTIMER_BASE(0) + CPUTIMER_PRD, 776);
  target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TRB_MASK | CPUTIMER_TCR_TIE_MASK);
  write_protected(REG_PCLKCR0, PCLKCR0_TBCLKSYNC_MASK);
  write_protected(REG_WDCR, 0x0028);
  target_enable_interrupts();
  for (;;) target_idle();
}

TEST_F(Run, TheSameHoweverItIsCut) {
  constexpr Tick end = 2'200'000;  // beyond the first watchdog reset
  start(busy_firmware);
  device->run_until(end);
  const auto whole_trace = trace;
  const auto whole_pwm = world.pwm;
  const auto whole_pins = world.pins;
  EXPECT_GT(whole_trace.size(), 1000u);
  EXPECT_GT(whole_pwm.size(), 1000u);
  EXPECT_EQ(device->statistics().resets, 1u);
  const auto events = device->statistics().events;

  world = RecordingWorld{};
  start(busy_firmware);
  std::uint32_t lfsr = 1;
  for (Tick t = 0; t < end;) {
    lfsr = lfsr * 1664525u + 1013904223u;
    t = std::min<Tick>(end, t + 1 + (lfsr >> 24));
    device->run_until(t);
  }
  EXPECT_EQ(trace, whole_trace);
  EXPECT_EQ(world.pwm, whole_pwm);
  EXPECT_EQ(world.pins, whole_pins);
  EXPECT_EQ(device->statistics().events, events);
}

TEST_F(Run, WorldsExceptionReachesTheCaller) {
  world.calls = {1000};
  world.on_call = [](Tick) { throw std::domain_error("the plant has left its domain"); };
  start([] { sleep_for_ever(); });
  EXPECT_THROW(device->run_until(2000), std::domain_error);
  EXPECT_EQ(device->now(), 1000);
  EXPECT_THROW(device->run_until(3000), std::domain_error);
}

TEST_F(Run, FirmwareThatReturnsIsAnError) {
  start([] { target_elapse(10); });
  EXPECT_THROW(device->run_until(2000), std::runtime_error);
  EXPECT_NE(device->error().find("returned"), std::string::npos) << device->error();
}

TEST_F(Run, TwoChipsTakeTurns) {
  RecordingWorld other_world;
  const Chip::Firmware blink = [] {
    write_protected(REG_GPADIR, 1);
    for (;;) target_write16(REG_GPATOGGLE, 1);
  };
  Chip other(other_world, blink);
  start(blink);
  for (Tick t = 0; t < 1000; t += 37) {
    device->run_until(t);
    other.run_until(t);
  }
  EXPECT_GT(world.pins.size(), 50u);
  EXPECT_EQ(world.pins, other_world.pins);
}

TEST_F(Run, InspectionChangesNothing) {
  start([] {
    write_protected(REG_HISPCP, 5);
    sleep_for_ever();
  });
  device->run_until(1000);
  const auto reads = device->statistics().reads;
  EXPECT_EQ(device->inspect(REG_HISPCP), 5);
  EXPECT_EQ(device->inspect(REG_ADCST), 0);  // gated
  EXPECT_EQ(device->statistics().reads, reads);
  EXPECT_EQ(device->statistics().gated_accesses, 0u);
  EXPECT_EQ(device->now(), 1000);
}

}  // namespace

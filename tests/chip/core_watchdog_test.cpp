// The watchdog: when it bites, what keeps it quiet, and what a reset does to the chip.

#include <gtest/gtest.h>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
std::vector<Tick> starts;
std::vector<std::uint16_t> control;  // WDCR at each start
std::uint16_t seen[4];

constexpr Tick kStep = 512 * 5;  // a count at OSCCLK / 512, 20 MHz
constexpr Tick kOverflow = 256 * kStep;
constexpr Tick kResetPulse = 512 * 5;

class Dog : public ::testing::Test {
 protected:
  void run(Chip::Firmware firmware, Tick until) {
    starts.clear();
    control.clear();
    device = std::make_unique<Chip>(world, firmware);
    chip = device.get();
    device->run_until(until);
  }
  std::uint64_t resets() const { return device->statistics().resets; }
  RecordingWorld world;
  std::unique_ptr<Chip> device;
};

void note_start() {
  starts.push_back(chip->now());
  control.push_back(target_read16(REG_WDCR));
}

TEST_F(Dog, ResetsAfter256CountsAndTellsSo) {
  run(
      [] {
        note_start();
        sleep_for_ever();
      },
      2 * kOverflow + kResetPulse - 1);  // just before the second one
  ASSERT_EQ(starts.size(), 2u);
  EXPECT_EQ(resets(), 1u);
  EXPECT_EQ(starts[1], kOverflow + kResetPulse);
  EXPECT_EQ(control[0] & WDCR_WDFLAG_MASK, 0);
  EXPECT_EQ(control[1] & WDCR_WDFLAG_MASK, WDCR_WDFLAG_MASK);
}

TEST_F(Dog, CounterCounts) {
  run(
      [] {
        target_elapse(static_cast<std::uint16_t>(10 * kStep / 10));
        seen[0] = target_read16(REG_WDCNTR);
        sleep_for_ever();
      },
      30'000);
  EXPECT_EQ(seen[0], 10);
}

TEST_F(Dog, KeysInOrderKeepItQuiet) {
  run(
      [] {
        for (;;) {
          target_elapse(50'000);  // 5 ms of the 6.55 ms allowed
          write_protected(REG_WDKEY, 0x55);
          write_protected(REG_WDKEY, 0xAA);
        }
      },
      10 * kOverflow);
  EXPECT_EQ(resets(), 0u);
}

TEST_F(Dog, KeysWithoutEallowDoNothing) {
  run(
      [] {
        for (;;) {
          target_elapse(50'000);
          target_write16(REG_WDKEY, 0x55);
          target_write16(REG_WDKEY, 0xAA);
        }
      },
      kOverflow + 100);
  EXPECT_EQ(resets(), 1u);
}

TEST_F(Dog, WrongKeyBreaksTheSequence) {
  run(
      [] {
        for (;;) {
          target_elapse(50'000);
          write_protected(REG_WDKEY, 0x55);
          write_protected(REG_WDKEY, 0x32);
          write_protected(REG_WDKEY, 0xAA);
        }
      },
      kOverflow + 100);
  EXPECT_EQ(resets(), 1u);
}

TEST_F(Dog, SecondKeyAloneDoesNothing) {
  run(
      [] {
        for (;;) {
          target_elapse(50'000);
          write_protected(REG_WDKEY, 0xAA);
        }
      },
      kOverflow + 100);
  EXPECT_EQ(resets(), 1u);
}

TEST_F(Dog, WrongCheckBitsResetAtOnce) {
  run(
      [] {
        note_start();
        if (starts.size() == 1) write_protected(REG_WDCR, 0x0040);
        disable_watchdog();
        sleep_for_ever();
      },
      20'000);
  EXPECT_EQ(resets(), 1u);
  ASSERT_EQ(starts.size(), 2u);
  EXPECT_EQ(starts[1], 50 + kResetPulse);  // a read of 3 cycles, EALLOW, the write; at 10 MHz
}

TEST_F(Dog, CanBeDisabled) {
  run(
      [] {
        disable_watchdog();
        sleep_for_ever();
      },
      4 * kOverflow);
  EXPECT_EQ(resets(), 0u);
}

TEST_F(Dog, PrescaleStretchesIt) {
  run(
      [] {
        write_protected(REG_WDCR, 0x002B);  // WDPS 3: divide by 4
        sleep_for_ever();
      },
      4 * kOverflow - 1);
  EXPECT_EQ(resets(), 0u);
  device->run_until(4 * kOverflow + 100);
  EXPECT_EQ(resets(), 1u);
}

TEST_F(Dog, OverrideLocksTheDisableBit) {
  run(
      [] {
        write_protected(REG_SCSR, SCSR_WDOVERRIDE_MASK);
        disable_watchdog();
        seen[0] = target_read16(REG_WDCR);
        sleep_for_ever();
      },
      kOverflow + 100);
  EXPECT_EQ(seen[0] & WDCR_WDDIS_MASK, 0);
  EXPECT_EQ(resets(), 1u);
}

TEST_F(Dog, InterruptModeWakesInsteadOfResetting) {
  static int woken;
  woken = 0;
  run(
      [] {
        install(VECTOR_WAKEINT, [] {
          ++woken;
          target_write16(REG_PIEACK, group_bit(1));
        });
        enable_pie();
        target_write_ier(group_bit(1));
        target_enable_interrupts();
        write_protected(REG_SCSR, SCSR_WDENINT_MASK);
        for (;;) target_idle();
      },
      3 * kOverflow + 1000);  // the ISR needs its time
  EXPECT_EQ(resets(), 0u);
  EXPECT_EQ(woken, 3);
}

TEST_F(Dog, ResetLowersPinsAndForgetsRegisters) {
  run(
      [] {
        note_start();
        seen[0] = target_read16(REG_PIEIER(1));
        seen[1] = target_read16(REG_GPADIR);
        seen[2] = target_read_ier();
        target_write16(REG_PIEIER(1), 0xFF);
        target_write_ier(0x0FFF);
        write_protected(REG_GPADIR, 1);
        target_write16(REG_GPASET, 1);
        sleep_for_ever();
      },
      kOverflow + kResetPulse - 1);
  ASSERT_EQ(world.pins.size(), 2u);
  EXPECT_EQ(world.pins[1], (PinChange{kOverflow, 0, false}));
  device->run_until(kOverflow + kResetPulse + 1000);
  ASSERT_EQ(starts.size(), 2u);
  EXPECT_EQ(seen[0], 0);
  EXPECT_EQ(seen[1], 0);
  EXPECT_EQ(seen[2], 0);
}

TEST_F(Dog, ResetRestoresClockGatesAndWaitStates) {
  run(
      [] {
        note_start();
        if (starts.size() == 1) {
          write_protected(REG_FBANKWAIT, 0x0303);
          write_protected(REG_PCLKCR1, 0x3F);
          write_protected(REG_WDCR, 0);
        }
        sleep_for_ever();
      },
      10'000);
  ASSERT_EQ(starts.size(), 2u);
  EXPECT_EQ(device->inspect(REG_FBANKWAIT), 0x0F0F);
  EXPECT_EQ(device->inspect(REG_PCLKCR1), 0);
}

TEST_F(Dog, BitesInsideAnInterruptToo) {
  run(
      [] {
        note_start();
        install(VECTOR_SEQ1INT, [] { sleep_for_ever(); });
        enable_pie();
        target_write_ier(group_bit(1));
        target_enable_interrupts();
        raise_by_hand(VECTOR_SEQ1INT);
        sleep_for_ever();
      },
      5 * (kOverflow + kResetPulse) + 1000);
  EXPECT_EQ(resets(), 5u);
  EXPECT_EQ(starts.size(), 6u);
  EXPECT_EQ(device->statistics().interrupts, 6u);
}

// Keeps the watchdog quiet below an interrupt that comes for ever.
std::uint64_t passes, ticks;

void live() {
  note_start();
  install(VECTOR_TINT0, [] {
    target_elapse(10);
    ++ticks;
    target_write16(REG_PIEACK, group_bit(1));
  });
  enable_pie();
  target_write_ier(group_bit(1));
  target_write32(CPUTIMER_BASE(0) + CPUTIMER_PRD, 999);
  target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TIE_MASK | CPUTIMER_TCR_TRB_MASK);
  target_enable_interrupts();
  for (;; ++passes) {
    target_elapse(1000);
    write_protected(REG_WDKEY, 0x55);
    write_protected(REG_WDKEY, 0xAA);
  }
}

TEST_F(Dog, EndsAProgramThatFails) {
  for (const auto failure : {stillspin::chip::Failure::kBackgroundHangs, stillspin::chip::Failure::kInterruptHangs}) {
    const bool background = failure == stillspin::chip::Failure::kBackgroundHangs;
    run(live, kOverflow);
    EXPECT_EQ(resets(), 0u);
    device->fail(failure);
    const std::uint64_t passes_then = passes, ticks_then = ticks;
    device->run_until(2 * kOverflow - 50'000);
    EXPECT_LE(passes, passes_then + 2) << "until the next interrupt";
    EXPECT_EQ(ticks > ticks_then + 10, background) << "what comes on top goes on";
    EXPECT_EQ(resets(), 0u);
    device->run_until(2 * kOverflow + 20'000);
    EXPECT_EQ(resets(), 1u);
    device->run_until(5 * kOverflow);
    EXPECT_EQ(resets(), 1u) << "it lives again";
    EXPECT_GT(passes, passes_then + 10);
  }
}

TEST_F(Dog, EndsAnIllegalInstructionThatItsInterruptLeadsBackTo) {
  static std::uint64_t traps;
  traps = 0;
  run(
      [] {
        install(VECTOR_ILLEGAL, [] { ++traps; });
        live();
      },
      kOverflow);
  EXPECT_EQ(traps, 0u);
  const std::uint64_t ticks_then = ticks;
  device->fail(stillspin::chip::Failure::kIllegalInstruction);
  device->run_until(2 * kOverflow + 20'000);
  EXPECT_GT(traps, 100u);
  EXPECT_GT(ticks, ticks_then + 10) << "in between";
  EXPECT_EQ(resets(), 1u);
}

}  // namespace

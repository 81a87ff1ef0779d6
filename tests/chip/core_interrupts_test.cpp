// The way of an interrupt: latency, priority, blocking without acknowledge, nesting, and the mistakes.

#include <gtest/gtest.h>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
std::vector<int> order;
Tick times[8];
std::uint16_t seen[8];

class Irq : public ::testing::Test {
 protected:
  void run(Chip::Firmware firmware, Tick until = 100'000) {
    order.clear();
    device = std::make_unique<Chip>(world, firmware);
    chip = device.get();
    device->run_until(until);
  }
  std::string error_of(Chip::Firmware firmware) {
    try {
      run(firmware);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return {};
  }
  RecordingWorld world;
  std::unique_ptr<Chip> device;
};

void acknowledge(unsigned group) { target_write16(REG_PIEACK, group_bit(group)); }

void open_groups(std::uint16_t groups) {
  enable_pie();
  target_write_ier(groups);
  target_enable_interrupts();
}

TEST_F(Irq, TakenAfterTheAccessThatRaisedIt) {
  run([] {
    install(VECTOR_SEQ1INT, [] {
      times[1] = chip->now();
      acknowledge(1);
      times[2] = chip->now();
    });
    open_groups(group_bit(1));
    times[0] = chip->now();
    raise_by_hand(VECTOR_SEQ1INT);
    times[3] = chip->now();
    sleep_for_ever();
  });
  // At 10 MHz: the write, 14 cycles of entry and 8 of context before the body, 8 + 8 after it.
  EXPECT_EQ(times[1] - times[0], 10 + 220);
  EXPECT_EQ(times[3] - times[2], 160);
  EXPECT_EQ(device->statistics().interrupts, 1u);
}

TEST_F(Irq, LatencyCountsFromTheFlag) {
  run([] {
    install(VECTOR_TINT0, [] {
      times[1] = chip->now();
      target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TSS_MASK);
      acknowledge(1);
    });
    open_groups(group_bit(1));
    target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TSS_MASK);
    target_write32(CPUTIMER_BASE(0) + CPUTIMER_PRD, 99);
    target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TRB_MASK | CPUTIMER_TCR_TIE_MASK);
    times[0] = chip->now();
    for (;;) target_idle();
  });
  EXPECT_EQ(times[1] - times[0], 990 + 220);  // 99 cycles to zero, then entry and context
}

TEST_F(Irq, LowerChannelAndGroupFirst) {
  run([] {
    install(VECTOR_SEQ1INT, [] {
      order.push_back(11);
      acknowledge(1);
    });
    install(VECTOR_SEQ2INT, [] {
      order.push_back(12);
      acknowledge(1);
    });
    install(VECTOR_EPWM1_INT, [] {
      order.push_back(31);
      acknowledge(3);
    });
    install(VECTOR_EPWM2_INT, [] {
      order.push_back(32);
      acknowledge(3);
    });
    enable_pie();
    target_write16(REG_PIEIFR(3), 0x03);
    target_write16(REG_PIEIFR(1), 0x03);
    open_groups(group_bit(1) | group_bit(3));
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{11, 12, 31, 32}));
}

TEST_F(Irq, PieOffersTheLowestChannelWhenItFetchesNotWhenItAsked) {
  // SEQ2 asks first, SEQ1 is flagged before the CPU lets the group in: the vector fetched is SEQ1's.
  run([] {
    install(VECTOR_SEQ1INT, [] {
      order.push_back(11);
      acknowledge(1);
    });
    install(VECTOR_SEQ2INT, [] {
      order.push_back(12);
      acknowledge(1);
    });
    enable_pie();
    target_write16(REG_PIEIFR(1), 0x02);
    target_write16(REG_PIEIFR(1), 0x03);
    open_groups(group_bit(1));
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{11, 12}));
}

TEST_F(Irq, GroupStaysBlockedWithoutAcknowledge) {
  run([] {
    install(VECTOR_SEQ1INT, [] { order.push_back(11); });  // forgets PIEACK
    install(VECTOR_EPWM1_INT, [] {
      order.push_back(31);
      acknowledge(3);
    });
    open_groups(group_bit(1) | group_bit(3));
    raise_by_hand(VECTOR_SEQ1INT);
    raise_by_hand(VECTOR_SEQ1INT);
    raise_by_hand(VECTOR_EPWM1_INT);  // another group is free
    seen[0] = target_read16(REG_PIEIFR(1));
    seen[1] = target_read16(REG_PIEACK);
    acknowledge(1);
    target_elapse(100);
    order.push_back(99);
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{11, 31, 11, 99}));
  EXPECT_EQ(seen[0], 1);
  EXPECT_EQ(seen[1], group_bit(1));
}

TEST_F(Irq, NestsOnlyWhenTheIsrSaysSo) {
  run([] {
    install(VECTOR_EPWM1_INT, [] {
      order.push_back(31);
      raise_by_hand(VECTOR_SEQ1INT);
      order.push_back(1);  // INTM is set: not yet
      seen[0] = target_read_ier();
      target_write_ier(group_bit(1));
      target_enable_interrupts();
      order.push_back(2);  // SEQ1 has run
      target_disable_interrupts();
      acknowledge(3);
    });
    install(VECTOR_SEQ1INT, [] {
      order.push_back(11);
      seen[1] = target_read_ier();
      acknowledge(1);
    });
    open_groups(group_bit(1) | group_bit(3));
    raise_by_hand(VECTOR_EPWM1_INT);
    seen[2] = target_read_ier();
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{31, 1, 11, 2}));
  EXPECT_EQ(seen[0], group_bit(1));  // its own group is shut
  EXPECT_EQ(seen[1], 0);
  EXPECT_EQ(seen[2], group_bit(1) | group_bit(3));  // restored
}

TEST_F(Irq, WaitsForIntm) {
  run([] {
    install(VECTOR_SEQ1INT, [] {
      order.push_back(11);
      acknowledge(1);
    });
    open_groups(group_bit(1));
    target_disable_interrupts();
    raise_by_hand(VECTOR_SEQ1INT);
    target_elapse(100);
    order.push_back(1);
    target_enable_interrupts();
    order.push_back(2);
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{1, 11, 2}));
}

TEST_F(Irq, ClearIfrForgetsARequestAndLeavesTheGroupBlocked) {
  run([] {
    install(VECTOR_SEQ1INT, [] {
      order.push_back(11);
      acknowledge(1);
    });
    enable_pie();
    target_write_ier(group_bit(1));
    raise_by_hand(VECTOR_SEQ1INT);
    target_clear_ifr();
    target_enable_interrupts();
    target_elapse(100);
    order.push_back(1);
    acknowledge(1);  // the PIE flag is still there: asks again
    target_elapse(100);
    order.push_back(2);
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{1, 11, 2}));
}

TEST_F(Irq, WithdrawnRequestRunsChannelOne) {
  run([] {
    install(VECTOR_SEQ1INT, [] {
      order.push_back(11);
      acknowledge(1);
    });
    install(VECTOR_SEQ2INT, [] {
      order.push_back(12);
      acknowledge(1);
    });
    enable_pie();
    target_write_ier(group_bit(1));
    raise_by_hand(VECTOR_SEQ2INT);
    target_write16(REG_PIEIER(1), 0x01);  // withdraws SEQ2 after the CPU has been asked
    target_enable_interrupts();
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{11}));
  EXPECT_EQ(device->statistics().spurious_interrupts, 1u);
}

TEST_F(Irq, VectorIsShownInPiectrl) {
  run([] {
    install(VECTOR_SEQ2INT, [] {
      seen[0] = target_read16(REG_PIECTRL);
      acknowledge(1);
    });
    open_groups(group_bit(1));
    raise_by_hand(VECTOR_SEQ2INT);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0], (0x0D00 + 2 * VECTOR_SEQ2INT) | PIECTRL_ENPIE_MASK);
}

TEST_F(Irq, MissingFunctionIsAnError) {
  const std::string error = error_of([] {
    enable_pie();
    target_write16(REG_PIEIER(1), 0x01);
    target_write_ier(group_bit(1));
    target_enable_interrupts();
    raise_by_hand(VECTOR_SEQ1INT);
    sleep_for_ever();
  });
  EXPECT_NE(error.find("illegal ISR"), std::string::npos) << error;
  EXPECT_NE(error.find("(32)"), std::string::npos) << error;
  EXPECT_THROW(device->run_until(200'000), std::runtime_error);  // a dead chip stays dead
}

TEST_F(Irq, DisabledPieIsAnError) {
  const std::string error = error_of([] {
    install(VECTOR_SEQ1INT, [] {});
    target_write_ier(group_bit(1));
    target_enable_interrupts();
    raise_by_hand(VECTOR_SEQ1INT);
    sleep_for_ever();
  });
  EXPECT_NE(error.find("ENPIE"), std::string::npos) << error;
}

TEST_F(Irq, RunawayNestingIsAnError) {
  const std::string error = error_of([] {
    install(VECTOR_SEQ1INT, [] {
      acknowledge(1);
      target_write_ier(group_bit(1));
      raise_by_hand(VECTOR_SEQ1INT);
      target_enable_interrupts();
    });
    open_groups(group_bit(1));
    raise_by_hand(VECTOR_SEQ1INT);
    sleep_for_ever();
  });
  EXPECT_NE(error.find("nested"), std::string::npos) << error;
}

TEST_F(Irq, IdleWithInterruptsMaskedWakesWithoutTakingOne) {
  run([] {
    install(VECTOR_TINT0, [] { order.push_back(1); });
    enable_pie();
    target_write_ier(group_bit(1));
    target_write16(CPUTIMER_BASE(0) + CPUTIMER_PRD, 99);
    target_write16(CPUTIMER_BASE(0) + CPUTIMER_TCR, CPUTIMER_TCR_TRB_MASK | CPUTIMER_TCR_TIE_MASK);
    target_idle();
    order.push_back(2);
    sleep_for_ever();
  });
  EXPECT_EQ(order, (std::vector<int>{2}));
  EXPECT_EQ(device->statistics().interrupts, 0u);
}

}  // namespace

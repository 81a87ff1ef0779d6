// Sequencers: pointers, cascading, what becomes of triggers that come while a burst runs, and interrupts.

#include "tests/chip/adc.hpp"

namespace stillspin::chip::testing {
namespace {

class AdcSequencing : public AdcBench {
 protected:
  unsigned pointer1() { return read(REG_ADCASEQSR) & ADCASEQSR_SEQ1_STATE_MASK; }
  unsigned pointer2() { return (read(REG_ADCASEQSR) & ADCASEQSR_SEQ2_STATE_MASK) >> ADCASEQSR_SEQ2_STATE_LSB; }
  unsigned counter() { return (read(REG_ADCASEQSR) & ADCASEQSR_SEQ_CNTR_MASK) >> ADCASEQSR_SEQ_CNTR_LSB; }
};

TEST_F(AdcSequencing, TwoBurstsOfAWindowLandInTheirOwnRegisters) {
  configure_for_the_drive();
  services.code = [](int channel, Tick t) { return static_cast<std::uint16_t>(channel + (t / 1000) % 10 * 100); };
  now = (now / 10000 + 1) * 10000;
  const Tick t0 = now;
  trigger(true);
  run(t0 + 1000);
  trigger(false);
  run(t0 + 2000);
  for (int n = 0; n < 8; ++n) {
    EXPECT_EQ(result(n), n % 2 == 0 ? 0u : 8u);
  }
  for (int n = 8; n < 14; ++n) {
    EXPECT_EQ(result(n), n % 2 == 0 ? 100u : 108u);
  }
  EXPECT_EQ(result(14), 101u) << "link voltage, A1";
  EXPECT_EQ(result(15), 109u);
  EXPECT_EQ(services.times_of(VECTOR_SEQ2INT), (Times{t0 + 1000 + burst(4)}));
}

TEST_F(AdcSequencing, TriggerOfTheOtherSequencerWaitsForTheEnd) {
  configure_for_the_drive();
  const Tick t0 = now;
  trigger(true);
  run(t0 + 60);
  trigger(false);
  EXPECT_TRUE(read(REG_ADCTRL2) & ADCTRL2_SOC_SEQ2_MASK);
  EXPECT_EQ(read(REG_ADCST) & (ADCST_SEQ1_BSY_MASK | ADCST_SEQ2_BSY_MASK), ADCST_SEQ1_BSY_MASK);
  run(t0 + 1000);
  EXPECT_EQ(services.samples[8].t, t0 + burst(4) + kTriggerToHold) << "80 ticks late, not where it was asked for";
  EXPECT_EQ(services.times_of(VECTOR_SEQ2INT), (Times{t0 + 2 * burst(4)}));
  EXPECT_EQ(adc.statistics().delayed_triggers, 1u);
  EXPECT_EQ(adc.statistics().lost_triggers, 0u);
}

TEST_F(AdcSequencing, OneTriggerWaitsFurtherOnesAreLost) {
  configure_for_the_drive();
  const Tick t0 = now;
  trigger(true);
  for (const Tick late : {30, 60, 90}) {
    run(t0 + late);
    trigger(true);
  }
  run(t0 + 2000);
  EXPECT_EQ(services.samples.size(), 16u) << "two bursts out of four triggers";
  EXPECT_EQ(adc.statistics().delayed_triggers, 1u);
  EXPECT_EQ(adc.statistics().lost_triggers, 2u);
}

TEST_F(AdcSequencing, FirstSequencerGoesFirst) {
  configure_for_the_drive();
  const Tick t0 = now;
  trigger(true);
  run(t0 + 30);
  trigger(false);
  run(t0 + 60);
  trigger(true);
  run(t0 + 2000);
  EXPECT_EQ(services.times_of(VECTOR_SEQ2INT), (Times{t0 + 3 * burst(4)}));
}

TEST_F(AdcSequencing, PointerStaysUntilReset) {
  write(REG_ADCMAXCONV, 1);  // two pairs
  write(REG_ADCCHSELSEQ1, 0x3210);
  write(REG_ADCTRL2, kBothTriggers);
  trigger(true);
  EXPECT_EQ(counter(), 1u);
  run(now + 500);
  EXPECT_EQ(pointer1(), 2u);
  EXPECT_EQ(counter(), 0u);
  services.forget();
  trigger(true);
  run(now + 500);
  EXPECT_EQ(services.samples[0].what, 2) << "goes on at CONV02";
  EXPECT_EQ(result(4), 102u);
  EXPECT_EQ(pointer1(), 0u) << "four pairs fill the eight registers";
  trigger(true);
  run(now + 500);
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_RST_SEQ1_MASK);
  EXPECT_EQ(pointer1(), 0u);
}

TEST_F(AdcSequencing, SequentialPointerTurnsAfterEight) {
  write(REG_ADCTRL3, kPowered);
  write(REG_ADCMAXCONV, 2);
  write(REG_ADCCHSELSEQ1, 0x3210);
  write(REG_ADCCHSELSEQ2, 0x7654);
  write(REG_ADCTRL2, kBothTriggers);
  for (int i = 0; i < 3; ++i) {
    trigger(true);
    run(now + 500);
  }
  EXPECT_EQ(pointer1(), 1u) << "nine conversions over eight states";
  EXPECT_EQ(services.samples.back().what, 0);
}

TEST_F(AdcSequencing, CascadeRunsOverAllSixteen) {
  write(REG_ADCTRL3, kPowered);
  write(REG_ADCTRL1, ADCTRL1_SEQ_CASC_MASK);
  write(REG_ADCMAXCONV, 15);
  write(REG_ADCCHSELSEQ1, 0x3210);
  write(REG_ADCCHSELSEQ2, 0x7654);
  write(REG_ADCCHSELSEQ3, 0xBA98);
  write(REG_ADCCHSELSEQ4, 0xFEDC);
  write(REG_ADCTRL2, ADCTRL2_EPWM_SOCB_SEQ_MASK | ADCTRL2_INT_ENA_SEQ1_MASK);
  const Tick t0 = now;
  trigger(true);
  EXPECT_EQ(adc.next_event(), kNever) << "SOCA is not enabled";
  trigger(false);
  run(t0 + 2000);
  for (int n = 0; n < 16; ++n) {
    EXPECT_EQ(result(n), 100u + static_cast<unsigned>(n));
  }
  EXPECT_EQ(services.times_of(VECTOR_SEQ1INT), (Times{t0 + 28 + 15 * 16 + 32}));
}

TEST_F(AdcSequencing, CascadeWithOnePairForEachTrigger) {
  write(REG_ADCTRL1, ADCTRL1_SEQ_CASC_MASK);
  write(REG_ADCMAXCONV, 0);
  write(REG_ADCCHSELSEQ1, 0x3210);
  write(REG_ADCCHSELSEQ2, 0x7654);
  write(REG_ADCTRL2, ADCTRL2_EPWM_SOCB_SEQ_MASK | ADCTRL2_EPWM_SOCA_SEQ1_MASK);
  for (int n = 0; n < 8; ++n) {
    trigger(n % 2 == 0);
    run(now + 300);
  }
  for (int n = 0; n < 8; ++n) {
    EXPECT_EQ(result(2 * n), 100u + static_cast<unsigned>(n));
    EXPECT_EQ(result(2 * n + 1), 108u + static_cast<unsigned>(n));
  }
  EXPECT_EQ(pointer1(), 0u);
}

TEST_F(AdcSequencing, TriggersHaveToBeEnabled) {
  write(REG_ADCTRL2, 0);
  trigger(true);
  trigger(false);
  EXPECT_EQ(adc.next_event(), kNever);
}

TEST_F(AdcSequencing, SoftwareStartsAndWithdraws) {
  configure_for_the_drive();
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_SOC_SEQ1_MASK);
  run(now + 10);
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_SOC_SEQ2_MASK);
  EXPECT_TRUE(read(REG_ADCTRL2) & ADCTRL2_SOC_SEQ2_MASK);
  write(REG_ADCTRL2, kBothTriggers);
  EXPECT_FALSE(read(REG_ADCTRL2) & ADCTRL2_SOC_SEQ2_MASK);
  run(now + 1000);
  EXPECT_EQ(services.samples.size(), 8u) << "the waiting start was withdrawn, the running one was not";
}

TEST_F(AdcSequencing, ResetEndsARunningSequence) {
  configure_for_the_drive();
  const Tick t0 = now;
  trigger(true);
  run(t0 + 60);
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_INT_ENA_SEQ1_MASK | ADCTRL2_RST_SEQ1_MASK);
  run(t0 + 1000);
  EXPECT_EQ(services.samples.size(), 4u);
  EXPECT_EQ(result(0), 100u) << "was ready";
  EXPECT_EQ(result(2), 0u) << "was not";
  EXPECT_TRUE(services.interrupts.empty());
  EXPECT_EQ(adc.statistics().aborted, 1u);
}

TEST_F(AdcSequencing, FlagThatIsNotClearedSendsNoSecondInterrupt) {
  configure_for_the_drive();
  trigger(true);
  run(now + 500);
  EXPECT_TRUE(read(REG_ADCST) & ADCST_INT_SEQ1_MASK);
  trigger(true);
  run(now + 500);
  EXPECT_EQ(services.times_of(VECTOR_SEQ1INT).size(), 1u);
  write(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK);
  EXPECT_EQ(read(REG_ADCST), 0);
  trigger(true);
  run(now + 500);
  EXPECT_EQ(services.times_of(VECTOR_SEQ1INT).size(), 2u);
}

TEST_F(AdcSequencing, InterruptModeTakesEveryOtherEnd) {
  configure_for_the_drive();
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_INT_ENA_SEQ1_MASK | ADCTRL2_INT_MOD_SEQ1_MASK);
  const Tick t0 = now;
  for (int i = 0; i < 4; ++i) {
    trigger(true);
    run(now + 500);
    write(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK);
  }
  EXPECT_EQ(services.times_of(VECTOR_SEQ1INT), (Times{t0 + 500 + burst(4), t0 + 1500 + burst(4)}));
}

TEST_F(AdcSequencing, ContinuousRunStartsOver) {
  configure_for_the_drive();
  write(REG_ADCTRL1, ADCTRL1_CONT_RUN_MASK);
  trigger(true);
  run(now + 3 * burst(4));
  EXPECT_EQ(adc.statistics().sequences, 3u);
  EXPECT_EQ(pointer1(), 0u);
  write(REG_ADCTRL1, 0);
  run(now + 1000);
  EXPECT_EQ(adc.statistics().sequences, 4u);
  EXPECT_EQ(adc.next_event(), kNever);
}

TEST_F(AdcSequencing, ModuleResetClearsEverything) {
  configure_for_the_drive();
  trigger(true);
  run(now + 60);
  write(REG_ADCTRL1, ADCTRL1_RESET_MASK);
  EXPECT_EQ(adc.next_event(), kNever);
  EXPECT_EQ(read(REG_ADCTRL3), 0);
  EXPECT_EQ(read(REG_ADCTRL2), 0);
  EXPECT_EQ(pointer1() + pointer2(), 0u);
}

}  // namespace
}  // namespace stillspin::chip::testing

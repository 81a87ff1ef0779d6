// When the ADC samples and when its results appear, against the tables of the data sheet (in ADCCLK).

#include "tests/chip/adc.hpp"

namespace stillspin::chip::testing {
namespace {

class AdcTiming : public AdcBench {};

TEST_F(AdcTiming, BurstOfFourPairs) {
  configure_for_the_drive();
  const Tick t0 = now;
  trigger(true);
  run(t0 + 1000);
  EXPECT_EQ(services.samples, (Samples{{0, t0 + 28},
                                       {8, t0 + 28},
                                       {0, t0 + 52},
                                       {8, t0 + 52},
                                       {0, t0 + 76},
                                       {8, t0 + 76},
                                       {0, t0 + 100},
                                       {8, t0 + 100}}));
  EXPECT_EQ(services.times_of(VECTOR_SEQ1INT), (Times{t0 + 140}));
  EXPECT_EQ(services.times_of(VECTOR_ADCINT), (Times{t0 + 140}));
  EXPECT_EQ(burst(4), 140);
}

TEST_F(AdcTiming, SampleTakesTheValueOfItsInstant) {
  configure_for_the_drive();
  services.code = [](int channel, Tick t) {
    return static_cast<std::uint16_t>((t % 1000) + (channel >= 8 ? 2000 : 0));
  };
  const Tick t0 = now;
  trigger(true);
  run(t0 + 200);
  for (int pair = 0; pair < 4; ++pair) {
    const unsigned at_hold = static_cast<unsigned>((t0 + kTriggerToHold + pair * kPairToPair) % 1000);
    EXPECT_EQ(result(2 * pair), at_hold);
    EXPECT_EQ(result(2 * pair + 1), at_hold + 2000);
  }
}

TEST_F(AdcTiming, ResultsAppearFourAndFiveClocksAfterTheHold) {
  configure_for_the_drive();
  const Tick t0 = now;
  trigger(true);
  const Tick hold = t0 + kTriggerToHold;
  run(hold + kHoldToResultA - 1);
  EXPECT_EQ(result(0), 0u);
  run(hold + kHoldToResultA);
  EXPECT_EQ(result(0), 100u);
  EXPECT_EQ(result(1), 0u);
  run(hold + kHoldToResultB);
  EXPECT_EQ(result(1), 108u);
  EXPECT_EQ(read(REG_ADCRESULT0 + 1), 108u << 4) << "left-justified in the wait-stated registers";
}

TEST_F(AdcTiming, SequentialSampling) {
  write(REG_ADCTRL3, kPowered);
  write(REG_ADCMAXCONV, 2);
  write(REG_ADCCHSELSEQ1, 0x0B31);
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_INT_ENA_SEQ1_MASK);
  const Tick t0 = now;
  trigger(true);
  run(t0 + 500);
  // hold at 3.5, then every 2 ADCCLK; last result 4 after the last hold
  EXPECT_EQ(services.samples, (Samples{{1, t0 + 28}, {3, t0 + 44}, {11, t0 + 60}}));
  EXPECT_EQ(services.times_of(VECTOR_SEQ1INT), (Times{t0 + 60 + 32}));
  EXPECT_EQ(result(0), 101u);
  EXPECT_EQ(result(1), 103u);
  EXPECT_EQ(result(2), 111u);
}

TEST_F(AdcTiming, AcquisitionWindowStretchesSampleAndSpacing) {
  configure_for_the_drive();
  write(REG_ADCTRL1, 3u << ADCTRL1_ACQ_PS_LSB);
  const Tick t0 = now;
  trigger(true);
  run(t0 + 1000);
  EXPECT_EQ(services.samples[0].t, t0 + 20 + 4 * kAdcClock);
  EXPECT_EQ(services.samples[2].t, services.samples[0].t + 6 * kAdcClock);
}

TEST_F(AdcTiming, ClockDividers) {
  configure_for_the_drive();
  services.hspclk = 2;
  write(REG_ADCTRL3, kPowered | ADCTRL3_SMODE_SEL_MASK | (2u << ADCTRL3_ADCCLKPS_LSB));  // 2 * (2*2) = 8
  const Tick t0 = now;
  trigger(true);
  run(t0 + 200);
  EXPECT_EQ(services.samples[0].t, t0 + 28);
  write(REG_ADCTRL1, ADCTRL1_CPS_MASK);  // 16 ticks
  services.forget();
  const Tick t1 = now;
  trigger(true);
  run(t1 + 400);
  EXPECT_EQ(services.samples[0].t, t1 + 56);
  services.forget();
  services.sysclk = 10;  // 160 ticks
  const Tick t2 = now;
  trigger(true);
  run(t2 + 4000);
  EXPECT_EQ(services.samples[0].t, t2 + 560);
}

TEST_F(AdcTiming, CodesAreZeroUntilPoweredForFiveMilliseconds) {
  now = 0;
  adc.reset(0);
  write(REG_ADCTRL3, kPowered | ADCTRL3_SMODE_SEL_MASK);
  configure_for_the_drive();
  now = Adc::kPowerUpTicks - kTriggerToHold - kPairToPair - 1;  // second pair one tick early, third late enough
  trigger(true);
  run(now + 200);
  EXPECT_EQ(result(0), 0u);
  EXPECT_EQ(result(3), 0u);
  EXPECT_EQ(result(4), 100u);
  write(REG_ADCTRL3, ADCTRL3_SMODE_SEL_MASK);
  write(REG_ADCTRL3, kPowered | ADCTRL3_SMODE_SEL_MASK);
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_RST_SEQ1_MASK);
  trigger(true);
  run(now + 200);
  EXPECT_EQ(result(4), 0u) << "the wait starts again after a power-down";
}

TEST_F(AdcTiming, OffsetTrimIsAddedAndClamped) {
  configure_for_the_drive();
  services.code = [](int channel, Tick) { return static_cast<std::uint16_t>(channel == 0 ? 4090 : 5); };
  write(REG_ADCOFFTRIM, 10);
  trigger(true);
  run(now + 200);
  EXPECT_EQ(result(0), 4095u);
  EXPECT_EQ(result(1), 15u);
  write(REG_ADCOFFTRIM, 0x1F6);  // -10
  write(REG_ADCTRL2, kBothTriggers | ADCTRL2_RST_SEQ1_MASK);
  trigger(true);
  run(now + 200);
  EXPECT_EQ(result(0), 4080u);
  EXPECT_EQ(result(1), 0u);
}

TEST_F(AdcTiming, CrosstalkOfEarlyRevisionsLiftsB) {
  configure_for_the_drive();
  services.code = [](int channel, Tick) { return static_cast<std::uint16_t>(channel == 0 ? 4095 : 1000); };
  adc.set_crosstalk(true);
  trigger(true);
  run(now + 200);
  EXPECT_EQ(result(0), 4095u);
  EXPECT_EQ(result(1), 1015u) << "4095/256 codes";
}

}  // namespace
}  // namespace stillspin::chip::testing

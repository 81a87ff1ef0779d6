// The chain that a sampled drive stands on: ePWM compare -> start of conversion -> samples -> SEQ2INT -> ISR ->
// results, each link at its tick, through the bus and with the board's clocks.

#include <gtest/gtest.h>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
Tick isr_time = 0;
std::uint16_t results[8];
std::uint16_t left_justified = 0;

// Two ways to an ADCCLK of 12.5 MHz: HISPCP and ADCTRL3.ADCCLKPS.
struct AdcClockRecipe {
  std::uint16_t hispcp;
  std::uint16_t adcclkps;
};
AdcClockRecipe recipe;

constexpr Tick kAdcClock = 8;  // ticks at 12.5 MHz
constexpr std::uint16_t kTrigger = 4000;

void window_isr() {
  isr_time = chip->now();
  for (std::uint32_t i = 0; i < 8; ++i) results[i] = target_read16(REG_MIRROR_ADCRESULT0 + 8 + i);
  left_justified = target_read16(REG_ADCRESULT0 + 8 + 3);
  target_write16(REG_ADCTRL2, ADCTRL2_RST_SEQ2_MASK | ADCTRL2_INT_ENA_SEQ2_MASK | ADCTRL2_EPWM_SOCB_SEQ2_MASK);
  target_write16(REG_ADCST, ADCST_INT_SEQ2_CLR_MASK);
  target_write16(REG_PIEACK, group_bit(1));
}

// ePWM1A rises at the compare value that also starts SEQ2: the edge marks the trigger's tick for the test.
void set_up_pwm() {
  target_write16(EPWM_BASE(1) + EPWM_TBPRD, 9999);
  target_write16(EPWM_BASE(1) + EPWM_CMPB, kTrigger);
  target_write16(EPWM_BASE(1) + EPWM_AQCTLA, 0x0201);  // clear at zero, set at CMPB up
  target_write16(EPWM_BASE(1) + EPWM_ETPS, 0x1000);
  target_write16(EPWM_BASE(1) + EPWM_ETSEL, 0xE000);  // SOCB at CMPB up
  target_write16(EPWM_BASE(1) + EPWM_TBCTL, 0);
}

void set_up_adc() {
  // Powered, simultaneous.
  target_write16(REG_ADCTRL3, static_cast<std::uint16_t>(0x00E1 | recipe.adcclkps << ADCTRL3_ADCCLKPS_LSB));
  target_write16(REG_ADCMAXCONV, 0x0030);
  target_write16(REG_ADCCHSELSEQ3, 0x1000);  // three pairs of A0/B0, then A1/B1
  target_write16(REG_ADCTRL2, ADCTRL2_INT_ENA_SEQ2_MASK | ADCTRL2_EPWM_SOCB_SEQ2_MASK);
}

extern "C" void chain_firmware() {
  start_clock();
  target_eallow();
  target_write16(REG_HISPCP, recipe.hispcp);
  target_write16(REG_PCLKCR0, PCLKCR0_ADCENCLK_MASK);
  target_write16(REG_PCLKCR1, PCLKCR1_EPWM1ENCLK_MASK);
  target_write32(REG_GPAMUX1, 1);
  target_edis();
  set_up_pwm();
  set_up_adc();
  install(VECTOR_SEQ2INT, window_isr);
  enable_pie();
  target_write_ier(group_bit(1));
  target_enable_interrupts();
  write_protected(REG_PCLKCR0, PCLKCR0_ADCENCLK_MASK | PCLKCR0_TBCLKSYNC_MASK);
  for (;;) target_idle();
}

class Chain : public ::testing::TestWithParam<AdcClockRecipe> {
 protected:
  void SetUp() override { recipe = GetParam(); }
};

INSTANTIATE_TEST_SUITE_P(Recipes, Chain,
                         ::testing::Values(AdcClockRecipe{0, 4}, AdcClockRecipe{4, 0}, AdcClockRecipe{1, 2}));

TEST_P(Chain, EveryLinkAtItsTick) {
  RecordingWorld world;
  Chip device(world, chain_firmware);
  chip = &device;
  device.run_until(2'000'000);  // the ADC needs 5 ms of power before it converts
  ASSERT_GT(world.pwm.size(), 10u);
  ASSERT_GE(world.samples.size(), 8u);

  // The last complete burst: the rising edge before the last eight samples.
  std::size_t edge = world.pwm.size() - 1;
  while (!world.pwm[edge].a || world.pwm[edge].t > world.samples.back().first) --edge;
  const Tick trigger = world.pwm[edge].t;
  const std::size_t first = world.samples.size() - 8;
  for (int pair = 0; pair < 4; ++pair) {
    // 2.5 ADCCLK to the window, 1 ADCCLK window, a pair each 3 ADCCLK.
    const Tick hold = trigger + 28 + 3 * kAdcClock * pair;
    const int channel = pair == 3 ? 1 : 0;
    EXPECT_EQ(world.samples[first + 2 * pair], std::make_pair(hold, channel));
    EXPECT_EQ(world.samples[first + 2 * pair + 1], std::make_pair(hold, channel + 8));
  }

  // Last hold, 5 ADCCLK to the last result, 14 cycles of entry and 8 of context (asleep: no access to finish).
  EXPECT_EQ(isr_time, trigger + 28 + 9 * kAdcClock + 5 * kAdcClock + 22);
  EXPECT_EQ(std::vector<int>(results, results + 8), (std::vector<int>{0, 800, 0, 800, 0, 800, 100, 900}));
  EXPECT_EQ(left_justified, 800 << 4);
  EXPECT_EQ(device.statistics().conversions_lost, 0u);
}

TEST_P(Chain, WorldIsCalledBeforeThePwmEdgeOfItsTick) {
  RecordingWorld world;
  Chip device(world, chain_firmware);
  chip = &device;
  device.run_until(2'000'000);
  const Tick edge = world.pwm.back().t + 10'000;  // the same edge of the next period
  std::size_t before = 0;
  world.calls = {edge};
  world.on_call = [&](Tick) { before = world.pwm.size(); };
  device.run_until(edge);
  EXPECT_EQ(world.pwm.back().t, edge);
  EXPECT_EQ(before, world.pwm.size() - 1);
}

TEST_P(Chain, PeriodIsExact) {
  RecordingWorld world;
  Chip device(world, chain_firmware);
  chip = &device;
  device.run_until(2'000'000);
  std::vector<Tick> rises;
  for (const PwmChange& change : world.pwm) {
    if (change.a) rises.push_back(change.t);
  }
  ASSERT_GT(rises.size(), 100u);
  for (std::size_t i = 1; i < rises.size(); ++i) EXPECT_EQ(rises[i] - rises[i - 1], 10'000);
}

}  // namespace

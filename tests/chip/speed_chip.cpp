// How fast the virtual chip is: the load of a drive's PWM period (100 us) without the drive's arithmetic.
//
// Per period: three legs with dead band (12 pin edges), three measuring windows of two conversion bursts (24 pairs), a
// control interrupt that writes the next compare values, and a window interrupt for each window that reads 16 results.
// The world does nothing, so that what is measured is the chip.

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"
#include "sim_host/chip/chip.hpp"

namespace {

using namespace stillspin::chip;

std::uint64_t edges = 0;
std::uint64_t samples = 0;
std::uint32_t sum = 0;

class QuietWorld final : public World {
 public:
  void on_pwm_pins(Tick, int, bool, bool) override { ++edges; }
  std::uint16_t adc_sample(Tick, int) override {
    ++samples;
    return 2048;
  }
  bool pin_level(Tick, int) override { return true; }
  void on_output_pin(Tick, int, bool) override {}
  std::int64_t encoder_edges(Tick) override { return 0; }
  Tick next_call() const override { return kNever; }
  void call(Tick) override {}
};

void window_isr() {
  for (std::uint32_t i = 0; i < 16; ++i) sum += target_read16(REG_MIRROR_ADCRESULT0 + i);
  target_write16(REG_ADCTRL2, 0x4949 | ADCTRL2_RST_SEQ1_MASK | ADCTRL2_RST_SEQ2_MASK);
  target_write16(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK | ADCST_INT_SEQ2_CLR_MASK);
  target_write16(REG_PIEACK, 1u << 0);
}

void control_isr() {
  target_write_ier(1u << 0);
  target_enable_interrupts();
  if (target_read16(EPWM_BASE(1) + EPWM_TBCTR) > 9000) std::abort();
  for (unsigned n = 1; n <= 6; ++n) {
    target_write16(EPWM_BASE(n) + EPWM_CMPA_CMPA, static_cast<std::uint16_t>(1000 * n));
    target_write16(EPWM_BASE(n) + EPWM_CMPB, static_cast<std::uint16_t>(1000 * n + 1500));
  }
  target_read32(EQEP_BASE(1) + EQEP_QPOSCNT);
  target_write32(REG_GPBTOGGLE, 4);
  target_elapse(2000);
  target_disable_interrupts();
  target_write16(EPWM_BASE(1) + EPWM_ETCLR, EPWM_ETCLR_INT_MASK);
  target_write16(REG_PIEACK, 1u << 2);
}

void set_up_pwm() {
  for (unsigned n = 1; n <= 6; ++n) {
    const std::uint32_t base = EPWM_BASE(n);
    target_write16(base + EPWM_TBPRD, 9999);
    target_write16(base + EPWM_CMPCTL, 0);
    target_write16(base + EPWM_CMPA_CMPA, static_cast<std::uint16_t>(1000 * n));
    target_write16(base + EPWM_CMPB, static_cast<std::uint16_t>(1000 * n + 1500));
    if (n <= 3) {
      target_write16(base + EPWM_AQCTLA, 2u << 4 | 1u << 8);
      target_write16(base + EPWM_DBCTL, 0x000B);
      target_write16(base + EPWM_DBRED, 200);
      target_write16(base + EPWM_DBFED, 200);
    } else {
      target_write16(base + EPWM_ETPS, 0x1100);
      target_write16(base + EPWM_ETSEL, 0xEC00);  // SOCA at CMPA up, SOCB at CMPB up
    }
    target_write16(base + EPWM_TBCTL, 0);
  }
  target_write16(EPWM_BASE(1) + EPWM_ETPS, 1);
  target_write16(EPWM_BASE(1) + EPWM_ETSEL, EPWM_ETSEL_INTEN_MASK | 1u);
}

void set_up_adc() {
  target_write16(REG_ADCTRL3, 0x00E0 | 0x0009);  // HSPCLK 100 MHz / 8, simultaneous
  target_write16(REG_ADCTRL1, 0);
  target_write16(REG_ADCMAXCONV, 0x0033);
  target_write16(REG_ADCTRL2, 0x0909);
}

void set_up_interrupts() {
  target_eallow();
  target_set_vector(VECTOR_SEQ2INT, window_isr);
  target_set_vector(VECTOR_EPWM1_INT, control_isr);
  target_edis();
  target_write16(REG_PIEIER(1), 2);
  target_write16(REG_PIEIER(3), 1);
  target_write16(REG_PIECTRL, 1);
  target_write_ier(1u << 0 | 1u << 2);
}

extern "C" void speed_firmware() {
  target_eallow();
  target_write16(REG_WDCR, 0x0068);
  target_write16(REG_PLLCR, 10);
  while ((target_read16(REG_PLLSTS) & PLLSTS_PLLLOCKS_MASK) == 0) {
  }
  target_write16(REG_HISPCP, 0);
  target_write16(REG_PCLKCR0, PCLKCR0_ADCENCLK_MASK);
  target_write16(REG_PCLKCR1, 0x403F);
  target_write32(REG_GPAMUX1, 0x00000555);
  target_write32(REG_GPBDIR, 4);
  target_edis();
  set_up_pwm();
  set_up_adc();
  set_up_interrupts();
  target_eallow();
  target_write16(REG_PCLKCR0, PCLKCR0_ADCENCLK_MASK | PCLKCR0_TBCLKSYNC_MASK);
  target_edis();
  target_enable_interrupts();
  for (;;) target_idle();
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  // Arguments: number of periods, number of cuts.
  const int periods = argc > 1 ? std::atoi(argv[1]) : 200'000;
  constexpr Tick period = 10'000;
  constexpr Tick settled = 2'000'000;
  QuietWorld world;
  Chip chip(world, speed_firmware);
  chip.run_until(settled);
  const Statistics before = chip.statistics();
  edges = samples = 0;
  const auto start = std::chrono::steady_clock::now();
  chip.run_until(settled + periods * period);
  const double whole = seconds_since(start);
  const Statistics& after = chip.statistics();
  const double n = periods;
  std::printf("per PWM period: %.2f us of host time\n", 1e6 * whole / n);
  std::printf("  %.1f accesses, %.1f events, %.1f interrupts, %.1f pin edges, %.1f samples\n",
              static_cast<double>(after.reads + after.writes - before.reads - before.writes) / n,
              static_cast<double>(after.events - before.events) / n,
              static_cast<double>(after.interrupts - before.interrupts) / n, static_cast<double>(edges) / n,
              static_cast<double>(samples) / n);

  const auto cut = std::chrono::steady_clock::now();
  const int cuts = argc > 2 ? std::atoi(argv[2]) : 1'000'000;
  for (int i = 0; i < cuts; ++i) chip.run_until(chip.now() + 1);
  std::printf("run_until of one tick: %.1f ns\n", 1e9 * seconds_since(cut) / cuts);
  return sum == 0;
}

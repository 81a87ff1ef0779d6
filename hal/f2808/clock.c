#include "hal/f2808/f2808_values.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/f2808/watchdog.h"
#include "hal/hal_clock.h"

// The PLL needs 131072 crystal cycles to lock, and the CPU runs at half the crystal's clock meanwhile: 65536 CPU
// cycles. Twice that many polls of at least POLL_CYCLES each is far beyond any lock time.
#define POLL_LIMIT 131072uL
#define POLL_CYCLES 10u

static bool wait_for_lock(void) {
  for (uint32_t poll = 0uL; poll < POLL_LIMIT; poll++) {
    if (reg_any(REG_PLLSTS, PLLSTS_PLLLOCKS_MASK)) {
      return true;
    }
    target_elapse(POLL_CYCLES);
  }
  return false;
}

static bool start_pll(void) {
  if (reg_any(REG_PLLSTS, PLLSTS_MCLKSTS_MASK)) {
    return false;  // limp mode: the crystal is dead and PLLCR may not be written
  }
  if (REG_GET_FIELD(REG_PLLCR, PLLCR_DIV) == PLLCR_DIV_TIMES_5) {
    return wait_for_lock();  // started by a debugger or a loader: writing it again would unlock it
  }
  target_eallow();
  // PLLCR may only be changed with the divider off and with the missing-clock detector off, which would else take the
  // relocking for a dead crystal.
  REG_SET_FIELD(REG_PLLSTS, PLLSTS_CLKINDIV, 0u);
  REG_SET_FIELD(REG_PLLSTS, PLLSTS_MCLKOFF, 1u);
  REG_SET_FIELD(REG_PLLCR, PLLCR_DIV, PLLCR_DIV_TIMES_5);
  target_edis();
  const bool locked = wait_for_lock();
  target_eallow();
  REG_SET_FIELD(REG_PLLSTS, PLLSTS_MCLKOFF, 0u);
  target_edis();
  return locked;
}

// From RAM: code in flash may not run while the flash's own timing changes.
TARGET_RAM_CODE static void set_flash_timing(void) {
  target_eallow();
  target_write16(REG_FOPT, FOPT_ENPIPE_MASK);
  target_write16(REG_FBANKWAIT, REG_FIELD(FBANKWAIT_PAGEWAIT, FLASH_PAGE_WAIT_STATES) |
                                    REG_FIELD(FBANKWAIT_RANDWAIT, FLASH_RANDOM_WAIT_STATES));
  target_write16(REG_FOTPWAIT, REG_FIELD(FOTPWAIT_OTPWAIT, FLASH_OTP_WAIT_STATES));
  target_edis();
  TARGET_FLUSH_PIPELINE();
}

static void start_peripheral_clocks(void) {
  target_eallow();
  REG_SET_FIELD(REG_HISPCP, HISPCP_HSPCLK, HISPCP_DIVIDE_BY_8);  // 12.5 MHz, which is ADCCLK undivided
  REG_SET_FIELD(REG_LOSPCP, LOSPCP_LSPCLK, LOSPCP_DIVIDE_BY_2);  // 50 MHz: the usual serial rates within 0.5 %
  // TBCLKSYNC stays 0: all PWM counters start together when they have been set up.
  target_write16(REG_PCLKCR0,
                 PCLKCR0_ADCENCLK_MASK | PCLKCR0_I2CAENCLK_MASK | PCLKCR0_SCIAENCLK_MASK | PCLKCR0_ECANAENCLK_MASK);
  target_write16(REG_PCLKCR1, PCLKCR1_EPWM1ENCLK_MASK | PCLKCR1_EPWM2ENCLK_MASK | PCLKCR1_EPWM3ENCLK_MASK |
                                  PCLKCR1_EPWM4ENCLK_MASK | PCLKCR1_EPWM5ENCLK_MASK | PCLKCR1_EPWM6ENCLK_MASK |
                                  PCLKCR1_EQEP1ENCLK_MASK);
  target_edis();
}

bool hal_clock_init(void) {
  watchdog_stop();
  if (!start_pll()) {
    return false;
  }
  set_flash_timing();
  start_peripheral_clocks();
  return true;
}

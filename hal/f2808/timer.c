#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_time.h"

#define TIMER CPUTIMER_BASE(2u)

void hal_time_init(void) {
  target_write16(TIMER + CPUTIMER_TCR, CPUTIMER_TCR_TSS_MASK);
  target_write16(TIMER + CPUTIMER_TPR, 0u);
  target_write16(TIMER + CPUTIMER_TPRH, 0u);
  target_write32(TIMER + CPUTIMER_PRD, 0xFFFFFFFFuL);
  // Reload while stopped, then run; FREE keeps it running when a debugger halts the CPU.
  target_write16(TIMER + CPUTIMER_TCR, CPUTIMER_TCR_TSS_MASK | CPUTIMER_TCR_TRB_MASK);
  target_write16(TIMER + CPUTIMER_TCR, CPUTIMER_TCR_FREE_MASK);
}

// The timer counts down.
uint32_t hal_time_cycles(void) { return 0xFFFFFFFFuL - target_read32(TIMER + CPUTIMER_TIM); }

void hal_idle(void) { target_idle(); }

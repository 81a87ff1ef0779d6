#include "hal/f2808/f2808_values.h"
#include "hal/f2808/pie.h"
#include "hal/f2808/pwm_modules.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_irq.h"
#include "hal/hal_replay.h"

#define CONTROL_GROUP PIE_GROUP(VECTOR_EPWM1_INT)
#define WINDOW_GROUP PIE_GROUP(VECTOR_SEQ2INT)

static struct {
  hal_isr_t control, window;
} functions;
static volatile uint16_t unexpected_count = 0u;

TARGET_RAM_CODE static TARGET_ISR void control_isr(void) { functions.control(); }

TARGET_RAM_CODE static TARGET_ISR void window_isr(void) { functions.window(); }

// Not acknowledged: an interrupt that nobody asked for must not come a second time.
static TARGET_ISR void unexpected_isr(void) {
  hal_pwm_gates_off();
  if (unexpected_count < UINT16_MAX) {
    unexpected_count++;
  }
}

static void clear_controller(void) {
  target_write16(REG_PIECTRL, 0u);
  for (uint16_t group = 1u; group <= PIE_GROUPS; group++) {
    target_write16(REG_PIEIER(group), 0u);
    target_write16(REG_PIEIFR(group), 0u);
  }
}

void hal_irq_install(hal_isr_t control, hal_isr_t window) {
  target_disable_interrupts();
  target_write_ier(0u);
  clear_controller();
  target_clear_ifr();
  functions.control = control;
  functions.window = window;
  unexpected_count = 0u;
  target_eallow();
  for (uint16_t vector = 0u; vector < VECTOR_COUNT; vector++) {
    target_set_vector(vector, unexpected_isr);
  }
  target_set_vector(VECTOR_EPWM1_INT, control_isr);
  target_set_vector(VECTOR_SEQ2INT, window_isr);
  target_edis();
  target_write16(REG_PIECTRL, PIECTRL_ENPIE_MASK);
}

// How many period starts make an interrupt; writing it also forgets those that have been counted.
static void count_period_starts(uint16_t events) {
  target_write16(EPWM_BASE(PWM_MASTER_MODULE) + EPWM_ETPS,
                 (uint16_t)(REG_FIELD(EPWM_ETPS_INTPRD, events) | PWM_MASTER_BURSTS));
}

void hal_irq_enable(void) {
  target_disable_interrupts();
  // From the peripheral to the CPU, so that nothing old is passed on behind the one who cleans. The event counter comes
  // first: a period start that waits in it for ETFLG to be cleared would set the flag again at once, and once its PIE
  // flag is wiped out too, no interrupt would ever come.
  count_period_starts(ET_NO_EVENT);
  target_write16(EPWM_BASE(PWM_MASTER_MODULE) + EPWM_ETCLR, EPWM_ETCLR_INT_MASK);
  target_write16(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK | ADCST_INT_SEQ2_CLR_MASK);
  // A group's flags may be written as a whole as long as none of its interrupts is enabled.
  target_write16(REG_PIEIER(CONTROL_GROUP), 0u);
  target_write16(REG_PIEIER(WINDOW_GROUP), 0u);
  target_write16(REG_PIEIFR(CONTROL_GROUP), 0u);
  target_write16(REG_PIEIFR(WINDOW_GROUP), 0u);
  target_clear_ifr();
  target_write16(REG_PIEIER(CONTROL_GROUP), PIE_CHANNEL_MASK(VECTOR_EPWM1_INT));
  target_write16(REG_PIEIER(WINDOW_GROUP), PIE_CHANNEL_MASK(VECTOR_SEQ2INT));
  pie_acknowledge(CONTROL_GROUP);
  pie_acknowledge(WINDOW_GROUP);
  count_period_starts(ET_EVERY_EVENT);
  target_write_ier((uint16_t)(PIE_GROUP_MASK(CONTROL_GROUP) | PIE_GROUP_MASK(WINDOW_GROUP)));
  target_enable_interrupts();
}

// The control interrupt's own group stays unacknowledged until the end, so only the window's can come. The return from
// the interrupt puts IER and INTM back.
TARGET_RAM_CODE void hal_irq_control_begin(void) {
  target_write_ier(PIE_GROUP_MASK(WINDOW_GROUP));
  target_enable_interrupts();
}

TARGET_RAM_CODE void hal_irq_control_end(void) {
  target_disable_interrupts();
  target_write16(EPWM_BASE(PWM_MASTER_MODULE) + EPWM_ETCLR, EPWM_ETCLR_INT_MASK);
  pie_acknowledge(CONTROL_GROUP);
}

TARGET_RAM_CODE uint16_t hal_irq_disable(void) {
  replay_call();
  return irq_hold();
}

TARGET_RAM_CODE void hal_irq_restore(uint16_t state) {
  replay_call();
  irq_release(state);
}

uint16_t hal_irq_unexpected_count(void) {
  replay_call();
  return replay_plays() ? replay_take() : replay_note(unexpected_count);
}

// The two interrupts of the drive.
//
// The control interrupt comes at every PWM period start. The window interrupt comes when a measuring window's samples
// are complete, up to three times a period, and may preempt the control interrupt between hal_irq_control_begin and
// hal_irq_control_end; what the two hand to each other must be double-buffered. Nothing preempts the window interrupt.

#ifndef STILLSPIN_HAL_HAL_IRQ_H
#define STILLSPIN_HAL_HAL_IRQ_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef void (*hal_isr_t)(void);  // a plain function; entry and return sequence are the HAL's

// Disables everything, fills the vector table and clears what was pending. Any vector that is not used here leads to a
// function that switches the gates off.
void hal_irq_install(hal_isr_t control, hal_isr_t window);

// Discards what has come in meanwhile and lets both interrupts through.
void hal_irq_enable(void);

// First and last call of the control function. begin lets the window interrupt preempt; end stops that, clears the
// interrupt's flag and acknowledges it. The window function needs no such pair: hal_adc_read_window acknowledges.
void hal_irq_control_begin(void);
void hal_irq_control_end(void);

// Holds both interrupts off for a few lines; they are kept pending. disable returns what restore has to be given.
uint16_t hal_irq_disable(void);
void hal_irq_restore(uint16_t state);

// How often a vector that nobody uses was taken since hal_irq_install; stays at 65535. Anything but 0 means a fault in
// the software or in the chip: such a group of interrupts stays blocked, so do not run the motor before a restart.
uint16_t hal_irq_unexpected_count(void);

#ifdef __cplusplus
}
#endif

#endif

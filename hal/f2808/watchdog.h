// What the drivers need of the watchdog beyond hal_time.h.

#ifndef STILLSPIN_HAL_F2808_WATCHDOG_H
#define STILLSPIN_HAL_F2808_WATCHDOG_H

// It runs from reset on, and at the start-up clock the PLL takes longer to lock than the watchdog waits.
void watchdog_stop(void);

#endif

// A free-running cycle counter, the watchdog and sleep.

#ifndef STILLSPIN_HAL_HAL_TIME_H
#define STILLSPIN_HAL_HAL_TIME_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_TIME_CYCLES_PER_US 100u  // one cycle is 10 ns
#define HAL_TIME_CYCLES_PER_S 100000000uL
#define HAL_WATCHDOG_PERIOD_US 26214uL  // service more often than this

// Starts the counter at 0. Needs hal_clock_init.
void hal_time_init(void);

// Cycles of 10 ns since hal_time_init; wraps after 42.9 s, so take differences of uint32_t.
uint32_t hal_time_cycles(void);

// From here on the chip is reset when the watchdog has not been serviced for HAL_WATCHDOG_PERIOD_US.
void hal_watchdog_start(void);
void hal_watchdog_service(void);

// True when the last reset was the watchdog's.
bool hal_watchdog_caused_reset(void);

// Sleeps until an interrupt has been taken.
void hal_idle(void);

#ifdef __cplusplus
}
#endif

#endif

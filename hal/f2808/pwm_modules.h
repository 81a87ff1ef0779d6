// What each of the six ePWM modules does.

#ifndef STILLSPIN_HAL_F2808_PWM_MODULES_H
#define STILLSPIN_HAL_F2808_PWM_MODULES_H

#include "hal/hal_board.h"
#include "hal/hal_pwm.h"

#define PWM_MASTER_MODULE 1u                                   // its zero is the period start
#define PWM_FIRST_LEG_MODULE BOARD_FIRST_LEG_MODULE            // and the next two: legs a, b, c
#define PWM_FIRST_WINDOW_MODULE (5u - BOARD_FIRST_LEG_MODULE)  // and the next two: windows 0, 1, 2; they drive no pins
#define PWM_LAST_MODULE 6u

// The trip flag of a leg does not tell who set it. This module, whose outputs go nowhere, is tripped by the
// over-current input and by nothing else, so its flag does.
#define PWM_TRIP_WITNESS_MODULE PWM_FIRST_WINDOW_MODULE

// Counts the slices (hal_sampling_timer.h): a window's, and not the master, which goes on with the period.
#define PWM_SLICE_MODULE \
  (PWM_FIRST_WINDOW_MODULE == PWM_MASTER_MODULE ? PWM_MASTER_MODULE + 1u : PWM_FIRST_WINDOW_MODULE)

// What the master's event trigger counts besides the period starts, as EPWM_ETPS has it: a window's bursts.
#define PWM_MASTER_BURSTS                                                                            \
  (PWM_FIRST_WINDOW_MODULE == PWM_MASTER_MODULE                                                      \
       ? REG_FIELD(EPWM_ETPS_SOCAPRD, ET_EVERY_EVENT) | REG_FIELD(EPWM_ETPS_SOCBPRD, ET_EVERY_EVENT) \
       : 0u)

#endif

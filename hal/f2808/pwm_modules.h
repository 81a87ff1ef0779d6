// What each of the six ePWM modules does.

#ifndef STILLSPIN_HAL_F2808_PWM_MODULES_H
#define STILLSPIN_HAL_F2808_PWM_MODULES_H

#include "hal/hal_pwm.h"

#define PWM_MASTER_MODULE 1u        // its zero is the period start
#define PWM_FIRST_LEG_MODULE 1u     // 1..3: legs a, b, c
#define PWM_FIRST_WINDOW_MODULE 4u  // 4..6: windows 0, 1, 2; they drive no pins
#define PWM_LAST_MODULE 6u

// The trip flag of a leg does not tell who set it. This module, whose outputs go nowhere, is tripped by the
// over-current input and by nothing else, so its flag does.
#define PWM_TRIP_WITNESS_MODULE 4u

#endif

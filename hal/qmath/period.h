// The PWM period in ticks of 10 ns: the unit of every instant inside a period. The floors above give it their own names
// (HAL_PWM_PERIOD_TICKS, SVPWM_PERIOD_TICKS, ESTIMATOR_PERIOD_TICKS); the number stands here alone.

#ifndef STILLSPIN_HAL_QMATH_PERIOD_H
#define STILLSPIN_HAL_QMATH_PERIOD_H

#define PERIOD_TICKS 10000  // 100 us

#endif

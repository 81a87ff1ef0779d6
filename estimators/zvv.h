// ZVV as the seed paper has it (section 3, eqs (20)-(24), Fig. 2): the q-axis current deviation under a zero vector.
//
//   D = s_q + (R i_q + lambda w^)/Lq,   Kq = R (Ld - Lq) i_d* / (Ld Lq),   angle error = D / Kq, then PI -> speed ->
//   angle.
//
// The drop of the devices is taken off D in the q-axis; along the d-axis it acts like R i_d* and belongs to Kq (at 3 A
// it is as large).
//
// It needs i_d* != 0. Only the integral part of the speed goes into D: with the whole PI output fed back one step later
// the loop is unstable unless Kp < Lq |Kq| / lambda, about 6 rad/s on the paper's motor. What the paper drops of the
// rotated slope, w (1 - Ld/Lq) id, biases the angle by w Ld / R, 1.8 degrees at 5 rpm and 22 at 60 rpm there, and the
// loop is slow (a few rad/s): it holds light loads near standstill with exact parameters, not more.
// deviation_observer.h uses both axes and all terms.

#ifndef STILLSPIN_ESTIMATORS_ZVV_H
#define STILLSPIN_ESTIMATORS_ZVV_H

#include "estimators/estimator.h"

#define ZVV_PERIODS 10  // as many without a zero vector the integral makes good with the next

typedef struct {
  int32_t kp_q30;  // Kp * T, per period
  int32_t ki_q40;  // Ki * T^2, per period^2
} zvv_config_t;

typedef struct {
  uint32_t angle_bam;
  int32_t speed_bpp;       // PI output
  int32_t integral_q8bpp;  // integral part, with eight more fractional bits, |speed| below 200 rpm or so
  int32_t deviation_q20;   // last D, A per period
  int32_t waited;          // periods since it was seen, up to ZVV_PERIODS
} zvv_t;

void zvv_preset(zvv_t* s, uint32_t angle_bam, int32_t speed_bpp);

/// D (22) without a loop behind it: the mean over the zero vectors among the windows, A per period, Q20, in the frame
/// of this angle (at the start of the running period) and speed. False, with nothing written, when there is no such
/// window.
bool zvv_deviation_q20(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, int32_t* deviation_q20);

/// A period in which nobody looks: the angle goes on with the speed as it is.
void zvv_wait(zvv_t* s);

/// id_reference_q20: i_d* in use, A.
estimator_output_t zvv_step(zvv_t* s, const zvv_config_t* c, const estimator_input_t* in, int32_t id_reference_q20);

#endif

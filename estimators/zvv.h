// ZVV as the seed paper has it (section 3, eqs (20)-(24), Fig. 2): the q-axis current deviation under a zero vector.
//
//   D = s_q + (R i_q + lambda w^)/Lq,   Kq = R (Ld - Lq) i_d* / (Ld Lq),   angle error = D / Kq, then PI -> speed ->
//   angle.
//
// What the print leaves out is said by zvv_config_t: the rotation's part of the measured slope, w (1 - Ld/Lq) id, which
// otherwise biases the angle by w Ld / R, 1.8 degrees at 5 rpm and 22 at 60 rpm on the paper's motor; that the integral
// alone goes into D and out as the speed: with the whole PI output fed back one step later the loop is unstable unless
// Kp < Lq |Kq| / lambda; and the devices' drops in D. They stay out of Kq on purpose: with
//
//   Kp = Lq |Kq| / lambda',   Ki = bandwidth of the speed times that,   lambda' = lambda - (Lq - Ld) i_d*
//
// Kp D / Kq is D Lq / lambda', the speed that the EMF tells, whatever else acts like R i_d. The angle's error then
// decays by itself: neither a wrong speed nor an acceleration turns it (docs/physics.md, section 3).
//
// It needs i_d* > 0 of some amperes. The load (Fig. 7) is what the torque makes less what the speed makes of it,
// through a low-pass of 20 ms.

#ifndef STILLSPIN_ESTIMATORS_ZVV_H
#define STILLSPIN_ESTIMATORS_ZVV_H

#include "estimators/estimator.h"

#define ZVV_PERIODS 10  // as many without a zero vector the integral makes good with the next

/// What the paper leaves out and the machine needs, and its load; each to be had or not (a mask).
enum {
  ZVV_ROTATION = 1,  // D without the rotation's part of the slope
  ZVV_INTEGRAL = 2,  // the integral alone is fed back into D, and is the speed
  ZVV_DROPS = 4,     // D without what the devices take
  ZVV_LOAD = 8       // the load of Fig. 7
};

typedef struct zvv_config {
  int32_t kp_q30;  // Kp * T, per period
  int32_t ki_q40;  // Ki * T^2, per period^2
  uint16_t terms;
} zvv_config_t;

typedef struct {
  uint32_t angle_bam;
  int32_t speed_bpp;       // PI output
  int32_t integral_q8bpp;  // integral part, with eight more fractional bits, |speed| below 200 rpm or so
  int32_t deviation_q20;   // last D, A per period
  int32_t load_accel_q8;   // acceleration that the load takes away (Fig. 7)
  int32_t waited;          // periods since D was seen, up to ZVV_PERIODS
} zvv_t;

void zvv_preset(zvv_t* s, uint32_t angle_bam, int32_t speed_bpp, int32_t load_accel_q8);

/// D (22) without a loop behind it: the mean over the zero vectors among the windows, A per period, Q20, in the frame
/// of this angle (at the start of the running period) and speed. False, with nothing written, when there is no such
/// window.
bool zvv_deviation_q20(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, int32_t* deviation_q20);

/// A period in which nobody looks: the angle goes on with the speed as it is.
void zvv_wait(zvv_t* s);

/// id_reference_q20: i_d* in use, A.
estimator_output_t zvv_step(zvv_t* s, const zvv_config_t* c, const estimator_input_t* in, int32_t id_reference_q20);

#endif

// The machine as the control sees it: constants per PWM period, so that a step of the model is a multiplication.
//
// Rotor frame, one period T as the unit of time:
//   s_d = y_d (v_d - R i_d)                + w kappa_d i_q
//   s_q = y_q (v_q - R i_q - w lambda / T) + w kappa_q i_d
// are the components of the *rotated alpha-beta slope* (current change per period), with y = T/L, w = omega T,
// kappa_d = Lq/Ld - 1 and kappa_q = 1 - Ld/Lq. Seed paper, eqs (15)-(20), with the rotation term kept.

#ifndef STILLSPIN_CONTROL_MACHINE_MODEL_H
#define STILLSPIN_CONTROL_MACHINE_MODEL_H

#include <stdbool.h>

#include "control/frame.h"

/// Physical parameters, all positive.
typedef struct {
  int32_t rs_q24;       // stator resistance with the devices' on-state resistance, ohm, 0.001..50
  int32_t ld_q30;       // d-axis inductance, H, 20e-6..0.5
  int32_t lq_q30;       // q-axis inductance, H, ld..0.5
  int32_t flux_q28;     // magnet flux linkage, V s, 0.001..1
  int32_t inertia_q24;  // kg m^2, 1e-5..1
  int32_t pole_pairs;   // 1..20
  int32_t period_us;    // PWM period, microseconds, 20..500
} machine_parameters_t;

typedef struct {
  int32_t rs_q24;          // ohm
  int32_t ld_q30, lq_q30;  // H
  int32_t flux_q28;        // V s
  int32_t yd_q30, yq_q30;  // T/L, A per V and period
  int32_t emf_q16;         // lambda/T: V per (rad per period)
  int32_t kappa_d_q24;     // Lq/Ld - 1
  int32_t kappa_q_q24;     // 1 - Ld/Lq
  int32_t torque_q24;      // 3/2 p lambda, N m per A of i_q at i_d = 0
  int32_t reluctance_q24;  // 3/2 p (Ld - Lq), N m per A^2
  int32_t accel_q12;       // electrical acceleration per torque, binary angle per period^2 and N m
  int32_t pole_pairs;
  int32_t periods_per_second;  // 1/T
} machine_model_t;

/// Derives the constants. Returns false, leaving the model unusable, when a parameter is outside its range or a
/// constant outside its format: T/L from 2 A/V, lambda/T from 32768 V, Lq/Ld from 129, too light a rotor.
bool machine_model_init(machine_model_t* m, const machine_parameters_t* p);

/// Recomputes what follows from the inductances after an adaptation changed yd/yq.
void machine_model_set_admittance(machine_model_t* m, int32_t yd_q30, int32_t yq_q30);

/// Electrical speed in rad per period, Q30, from binary angle per period (|speed| below 1.9 rad per period).
static inline int32_t machine_speed_rad_q30(int32_t speed_bpp) {
  return q_mul(speed_bpp, 1686629713L, 30);  // 2 pi / 4
}

/// Air-gap torque, N m Q16, of mean currents in A Q20. Seed paper eq (2) with P/2 instead of the misprinted P.
int32_t machine_torque_q16(const machine_model_t* m, dq_t current_q20);

/// Torque constant at a given i_d, N m per A, Q24: 3/2 p (lambda + (Ld - Lq) i_d).
int32_t machine_torque_constant_q24(const machine_model_t* m, int32_t id_q20);

#endif

// The machine as the control sees it: constants per PWM period, so that a step of the model is a multiplication.
//
// Rotor frame, one period T as the unit of time, at the operating point (machine_map.h), w = omega T:
//   s = Y (v - R i) + w h,    h = K i + k0
// is the *rotated alpha-beta slope* (current change per period): di_dq/dt + w J i with L di_dq/dt = v - R i - w J psi.
// Y = T L^-1 is the incremental inverse inductance, and with the flux psi/T = L/T i + psi0 around the operating point
//   K = J - Y J L / T,  k0 = -Y J psi0.
// Without saturation K = [0, Lq/Ld - 1; 1 - Ld/Lq, 0] and k0 = (0, -lambda/Lq): seed paper, eqs (15)-(20), with the
// rotation term kept.

#ifndef STILLSPIN_CONTROL_MACHINE_MODEL_H
#define STILLSPIN_CONTROL_MACHINE_MODEL_H

#include <stdbool.h>

#include "control/frame.h"
#include "control/machine_map.h"

/// Physical parameters, all positive.
typedef struct {
  int32_t rs_q24;       // stator resistance with the devices' on-state resistance, ohm, 0.001..50
  int32_t ld_q30;       // d-axis inductance at no current, H, 33.4e-6..0.5
  int32_t lq_q30;       // q-axis inductance at no current, H, ld..0.5
  int32_t flux_q28;     // magnet flux linkage, V s, 0.001..1
  int32_t inertia_q24;  // kg m^2, 1e-5..1
  int32_t pole_pairs;   // 1..30
  int32_t period_us;    // PWM period, microseconds, 20..500
} machine_parameters_t;

#define MACHINE_SPEED_END_BPP 1298773986L    // 1.9 rad per period: the fastest that the model's formats hold
#define MACHINE_PSI_VARIANCE_Q32 386547057L  // 0.09

/// What the drive learns while it runs, added to what the parameters say.
typedef struct {
  int32_t mean_q30, half_q30;         // of (ydd + yqq)/2 and (ydd - yqq)/2 at no current
  int32_t ydd_q24, yqq_q24, ydq_q24;  // the same as shares of the map, machine_model_trim
  int32_t psi_share_q24;              // of the map's flux along q: its inductance has changed with yqq
  int32_t rs_q24;                     // of the resistance, ohm
  int32_t psi_q16;                    // of the magnet's flux/T, V per (rad per period)
  int32_t psi_variance_q32;           // its uncertainty: 1 where a voltage error at 1/50 rad per period told as much
} machine_trim_t;

typedef struct {
  int32_t nominal_rs_q24;        // ohm
  int32_t ld_q30, lq_q30;        // H, at no current
  q_inverse_t per_ld;            // of ld_q30
  int32_t flux_q28;              // V s
  int32_t emf_q16;               // lambda/T: V per (rad per period)
  int32_t torque_q24;            // 3/2 p lambda, N m per A of i_q at i_d = 0
  int32_t reluctance_q24;        // 3/2 p (Ld - Lq), N m per A^2
  int32_t accel_q12;             // electrical acceleration per torque, binary angle per period^2 and N m
  int32_t torque_per_accel_q24;  // and back: N m (Q16) per acceleration (Q8), Q24
  int32_t periods_per_second;    // 1/T
  int32_t ld_q16;                // L_d/T, V/A, up to 32767
  int32_t period_q30;            // T, s
  machine_map_t map;
  q_inverse_t per_ydd0, per_yqq0, per_half0;  // of the map at no current: ydd, yqq, (ydd - yqq)/2
  machine_trim_t trim;
  // At the operating point, see machine_model_move.
  int32_t iq_q20;                        // A
  int32_t rs_q24;                        // ohm
  int32_t yd_q30, yq_q30, ydq_q30;       // Y
  machine_slope_t slope;                 // of it
  q_inverse_t per_yq;                    // of yq_q30
  int32_t k_dd_q24, k_dq_q24, k_qd_q24;  // K; K_qq = -K_dd
  dq_t k0_q20;                           // A per period and (rad per period)
  int32_t psi_d_q16, psi_q_q16;          // psi/T at i_d = 0, V per (rad per period)
} machine_model_t;

/// Derives the constants, without saturation. Returns false, leaving the model unusable, when Lq is the smaller one or
/// a constant outside its format: T/L above 0.6 A/V, lambda/T above 32000 V, Lq/Ld from 64, lambda/L from 1000 A, 3/2 p
/// lambda above 30 N m/A, too light a rotor.
bool machine_model_init(machine_model_t* m, const machine_parameters_t* p);

/// Replaces the map by one with saturation. False, with the old one kept, when it is not usable (machine_map.h).
bool machine_model_saturate(machine_model_t* m, const machine_map_parameters_t* map);

/// What the inverse inductances at no current have more than the map. All of the map changes in proportion: inductances
/// that differ do so saturated as well, and the axis of the saliency turns to where the map has it. Where they change
/// by more than twice or half, machine_model_settle follows.
void machine_model_trim(machine_model_t* m, int32_t mean_q30, int32_t half_q30);

/// Takes the flux's share all of the way to what the trim makes of it.
void machine_model_settle(machine_model_t* m);

/// Takes an acceleration per torque that is this ratio (Q24, 1/8 to 8) of the one that the parameters say.
void machine_model_scale_inertia(machine_model_t* m, const machine_model_t* nominal, int32_t ratio_q24);

/// Moves the operating point to a torque current, up to 512 A, and takes the trim into account.
void machine_model_move(machine_model_t* m, int32_t iq_q20);

/// The same in two parts that need not come together. To follow takes Y and the flux along, and leaves K, which says
/// how h changes around the operating point, as it is. To turn makes K of Y, with two reciprocals. h at the torque
/// current is right in between.
void machine_model_follow(machine_model_t* m, int32_t iq_q20);
void machine_model_renew_sensitivity(machine_model_t* m);

/// Y x, Q20, of a voltage in V Q16.
static inline dq_t machine_admit_q20(const machine_model_t* m, dq_t v_q16) {
  const dq_t s = {q_mul_add_floor(m->yd_q30, v_q16.d, m->ydq_q30, v_q16.q, 26),
                  q_mul_add_floor(m->ydq_q30, v_q16.d, m->yq_q30, v_q16.q, 26)};
  return s;
}

/// What products of K (Q24) and a current (Q20) make with k0, A per period and (rad per period), Q20. A saliency that
/// was learnt may turn more than the format holds.
static inline int32_t machine_sensitivity_q20(int64_t of_current_q44, int64_t k0_q20) {
  return q_sat64(q_shr64(of_current_q44, 24) + k0_q20);
}

/// h = K i + k0: what the slope changes with the speed.
static inline dq_t machine_speed_sensitivity_q20(const machine_model_t* m, dq_t i_q20) {
  const dq_t h = {
      machine_sensitivity_q20(q_mac(q_product(m->k_dd_q24, i_q20.d), m->k_dq_q24, i_q20.q), m->k0_q20.d),
      machine_sensitivity_q20(q_product(m->k_qd_q24, i_q20.d) - q_product(m->k_dd_q24, i_q20.q), m->k0_q20.q)};
  return h;
}

/// Electrical speed in rad per period, Q30, from binary angle per period (|speed| below 1.9 rad per period).
static inline int32_t machine_speed_rad_q30(int32_t speed_bpp) {
  return q_mul_floor(speed_bpp, 1686629713L, 30);  // 2 pi / 4
}

/// Voltage induced by the rotation, V Q16, at the operating point and a current in A Q20: w (-psi_q, psi_d).
static inline dq_t machine_rotational_voltage_q16(const machine_model_t* m, dq_t i_q20, int32_t speed_bpp) {
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  // L_d i_d / T as V per (rad per period).
  const int64_t along_q36 = q_mac(q_product(m->psi_d_q16, 1048576L), m->ld_q16, i_q20.d);
  const dq_t v = {q_mul_floor(m->psi_q_q16, -w_q30, 30), q_mul_floor(q_sat64(q_shr64(along_q36, 20)), w_q30, 30)};
  return v;
}

/// Air-gap torque, N m Q16, of mean currents in A Q20. Seed paper eq (2) with P/2 instead of the misprinted P.
int32_t machine_torque_q16(const machine_model_t* m, dq_t current_q20);

/// Torque constant at a given i_d, N m per A, Q24: 3/2 p (lambda + (Ld - Lq) i_d).
int32_t machine_torque_constant_q24(const machine_model_t* m, int32_t id_q20);

#endif

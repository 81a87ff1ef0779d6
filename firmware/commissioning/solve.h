// From the sums of a commissioning to physical values, at the background level. No state, no parameters: sums in,
// values out, so that tests can feed them sums of a made-up machine.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_SOLVE_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_SOLVE_H

#include "firmware/commissioning/commissioning.h"

typedef struct {
  bool valid;
  int32_t resistance_q24;                   // winding and devices, ohm
  int32_t drop_error_q16;                   // true device drop less the assumed one, V
  int32_t edge_error_q16;                   // voltage lost at the edges beyond what the assumed delays explain, V
  int32_t command_rms_q16, window_rms_q16;  // what the two fits leave over, V; beyond all bounds when the shaft moved
  int32_t link_q16;                         // DC link, V
} staircase_values_t;

/// Inductances in mH, Q20.
typedef struct {
  bool valid;
  int32_t ldd_q20, lqq_q20, ldq_q20;
  int32_t turn_bam;     // of the saliency axis at +i_q
  int32_t apart_bam;    // half of what the trains and their mirror image differ by in it
  int32_t share_q24;    // by which the shaft moved more than predicted, as a share
  int32_t current_q20;  // mean |i_q|, A
} map_values_t;

typedef struct {
  bool valid;
  int32_t flux_q28;                          // Vs
  int32_t flux_low_q28;                      // from the low speed alone: what offsets are worth
  int32_t friction_q24;                      // N m s
  int32_t inertia_up_q24, inertia_down_q24;  // kg m^2
  int32_t inertia_q24;                       // their mean
} spin_values_t;

/// m: the model whose slopes were taken off; its resistance includes the devices'.
staircase_values_t staircase_solve(const staircase_t* s, const machine_model_t* m);

/// Without current: ldq and turn are zero.
map_values_t unsaturated_solve(const tensor_sums_t* s, const machine_model_t* m);

map_values_t map_solve(const map_group_t group[MAP_GROUPS], const machine_model_t* m);

/// Mutual inductances at the four levels, mH Q20, as an odd function a i + b i^3 of the current, which they are in any
/// machine at i_d = 0 that is little saturated. Replaces them by the fitted ones and returns true when those lie within
/// a tenth of the largest, or within 0.1 degrees of the axis: 1/512 of the saliency, Lq - Ld, mH Q20.
bool map_smooth(int32_t ldq_q20[MAP_LEVELS], int32_t saliency_q20);

/// Whether a level's trains and their mirror image saw the same turn of the axis: both within a tenth of it, or within
/// 0.1 degrees, of their mean.
bool map_repeats(const map_values_t* v);

/// Whether a value is within a factor of another one, which is no less than the factor. None at or below 0 is.
bool solve_is_near(int32_t value, int32_t other, int32_t factor);

/// From one value towards another by a share.
int32_t map_along(int32_t from, int32_t to, int32_t share_q24);

/// Moves a level's inductances to the current that was meant, along the line from the level below.
void map_refer(map_values_t* v, const map_values_t* below, int32_t current_q20);

/// resistance_q24: of winding and devices, ohm; ld_q30: H, for the voltage of what field weakening there was.
spin_values_t spin_solve(const spin_t* s, int32_t resistance_q24, int32_t ld_q30, int32_t pole_pairs);

/// Mismatch g of the current sensors beyond the one already taken off, Q30.
int32_t unsaturated_mismatch_q30(const tensor_sums_t* s, const machine_model_t* m);

#endif

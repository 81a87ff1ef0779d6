// The machine's inductances against the torque current: saturation and cross-saturation as a table.
//
// Each point holds, at i_d = 0 and i_q = k/4 of the map's last current, the inverse of the incremental inductance
// matrix, y = T L^-1 (A per V and period), and the flux linkage psi/T (V per rad and period), which follows from the
// inductances because a field that stores energy has dpsi_d/di_q = dpsi_q/di_d:
//   psi_d(0, i_q) = lambda + integral of Ldq di_q,  psi_q(0, i_q) = integral of Lqq di_q
// Between the points everything is a straight line; Ldq and psi_q are odd in i_q, the rest is even. A machine without
// saturation has four times the same point.

#ifndef STILLSPIN_CONTROL_MACHINE_MAP_H
#define STILLSPIN_CONTROL_MACHINE_MAP_H

#include <stdbool.h>

#include "hal/qmath/qmath.h"

#define MACHINE_MAP_SEGMENTS 4
#define MACHINE_MAP_POINTS (MACHINE_MAP_SEGMENTS + 1)

/// Incremental inductances, H Q30, at i_q = 0, 1/4 .. 4/4 of `current`. Ldq[0] is 0.
typedef struct {
  int32_t current_q20;  // i_q of the last point, A, 1..100
  int32_t ldd_q30[MACHINE_MAP_POINTS], lqq_q30[MACHINE_MAP_POINTS], ldq_q30[MACHINE_MAP_POINTS];
} machine_map_parameters_t;

typedef struct {
  int32_t ydd_q30, yqq_q30, ydq_q30;  // T L^-1, A per V and period
  int32_t psi_d_q16, psi_q_q16;       // psi/T at i_d = 0, V per (rad per period)
} machine_point_t;

typedef struct {
  machine_point_t points[MACHINE_MAP_POINTS];
  int32_t per_segment_q26;  // segments per ampere
} machine_map_t;

/// How the inverse inductances go with the torque current at a point: what a segment of it changes.
typedef struct {
  int32_t yqq_q30, ydq_q30;  // A per V and period, a segment
} machine_slope_t;

/// Derives the points; period_q30: T in s, emf_q16: lambda/T. False when an inductance matrix is not positive definite
/// with Ldd <= Lqq, or a value does not fit its format (y above 0.6 A/V, or 0.45 across, psi/T above 32000 V).
bool machine_map_init(machine_map_t* map, const machine_map_parameters_t* p, int32_t period_q30, int32_t emf_q16);

/// The point at a torque current of either sign. Beyond the table's end the inverse inductances stay, the flux goes on,
/// up to 128 segments and 32768 V. The slope is that of the straight line, but for yqq in the first segment: it is
/// even, so its slope grows from nothing, as that of a parabola.
machine_point_t machine_map_at(const machine_map_t* map, int32_t iq_q20, machine_slope_t* slope);

#endif

#include "firmware/commissioning/solve.h"

#include "estimators/axis.h"
#include "estimators/fit.h"
#include "hal/qmath/qcall.h"

#define EIGHTH_BAM 536870912L
#define FACTOR_LEAST_Q20 1048576L  // three quarters of that
#define SQRT3_Q28 464943848L
#define TENTH_DEGREE_BAM 1193046L
#define AXIS_PARTS 512  // of the saliency: mutual inductance that turns the axis by 0.1 degrees
// 2^32 T / 2 pi with T = 100 us: binary angle per period of 1 rad/s.
#define BPP_PER_RAD_Q12 279988337LL  // 68356.5
#define BPP_PER_RAD_Q4 1093704LL
// 2^32 T^2 / 2 pi: binary angle per period^2 of 1 rad/s^2.
#define BPP_PER_ACCEL_Q16 447981LL  // 6.83565

typedef struct {
  int32_t current[STAIRCASE_LEVELS], factor[STAIRCASE_LEVELS], voltage[STAIRCASE_LEVELS];
  bool stayed;
} columns_t;

static int32_t for_fit(int32_t x) { return q_limit(x, FIT_END); }

// Two words of arguments less at each place than the quotient with its shift.
static int32_t over(int64_t sum, int32_t count) { return fit_ratio(sum, count, 0); }

static int32_t mean_of(int64_t sum, int32_t count) { return for_fit(over(sum, count)); }

// The link falls under the vector along the current and rises under its opposite. Where its own time constant is about
// a pulse, the mean misses this, and the windows, which are behind the pulses' beginnings, twice as much; where it is
// much longer there is little of it.
static int32_t sag_q20(const staircase_level_t* l) { return for_fit(q_div(over(l->sag, l->periods), l->link_q16, 24)); }

// A shaft that stays where it was taken to has no phase near zero, and a volt of drop is 4/3 V along d at every level:
// stayed.
static bool command_columns(const staircase_t* s, columns_t* c) {
  c->stayed = true;
  for (uint16_t k = 0; k < STAIRCASE_LEVELS; k++) {
    const staircase_level_t* const l = &s->level[k];
    if (l->periods == 0 || l->windows == 0) return false;
    c->current[k] = mean_of(l->current, l->periods);
    c->factor[k] = mean_of(l->factor, l->periods);
    c->stayed = c->stayed && qc_abs_sat(c->factor[k]) >= FACTOR_LEAST_Q20;
    c->voltage[k] = for_fit(mean_of(l->command, l->periods) + sag_q20(l));
  }
  return true;
}

// What the command has and the windows have not: the resistance is in both, whatever it is.
static void edge_column(const staircase_t* s, const machine_model_t* m, columns_t* c) {
  for (uint16_t k = 0; k < STAIRCASE_LEVELS; k++) {
    const staircase_level_t* const l = &s->level[k];
    const int32_t missing_q20 = qc_sub_sat(2 * sag_q20(l), q_div(over(l->residual, l->windows), m->yd_q30, 30));
    const int32_t seen_q20 = qc_add_sat(missing_q20, qc_mul_sat(m->rs_q24, c->current[k], 24));
    c->voltage[k] = for_fit(qc_sub_sat(c->voltage[k], seen_q20));
  }
}

staircase_values_t staircase_solve(const staircase_t* s, const machine_model_t* m) {
  staircase_values_t v = {false, 0, 0, 0, 0, 0, 0};
  columns_t c;
  fit_plane_t plane;
  if (!command_columns(s, &c)) return v;
  if (!fit_plane(c.current, c.factor, c.voltage, STAIRCASE_LEVELS, &plane)) return v;
  v.resistance_q24 = plane.slope_q24;
  v.command_rms_q16 = c.stayed ? plane.rms / 16 : INT32_MAX;
  edge_column(s, m, &c);
  // Under the zero vector the resistance is the windows'. What the command differs by in it is none of the edges'.
  const int32_t both_q16 = plane.offset_q24 / 256;
  if (s->at_zero && fit_plane(c.current, c.factor, c.voltage, STAIRCASE_LEVELS, &plane)) {
    v.resistance_q24 = qc_sub_sat(v.resistance_q24, plane.slope_q24);
    for (uint16_t k = 0; k < STAIRCASE_LEVELS; k++) c.voltage[k] -= qc_mul_sat(plane.slope_q24, c.current[k], 24);
  }
  const int64_t square = fit_dot(c.factor, c.factor, STAIRCASE_LEVELS);
  v.edge_error_q16 = fit_ratio(fit_dot(c.factor, c.voltage, STAIRCASE_LEVELS), square, 16);
  v.drop_error_q16 = qc_sub_sat(both_q16, v.edge_error_q16);
  int64_t rest = 0;
  for (uint16_t k = 0; k < STAIRCASE_LEVELS; k++) {
    const int32_t left = for_fit(qc_sub_sat(c.voltage[k] / 16, qc_mul_sat(v.edge_error_q16, c.factor[k], 20)));
    rest += (int64_t)left * left;
  }
  v.window_rms_q16 = c.stayed ? (int32_t)q_sqrt64((uint64_t)rest / STAIRCASE_LEVELS) : INT32_MAX;
  v.link_q16 = s->level[0].link_q16;
  v.valid = true;
  return v;
}

// Inductances from the inverse inductances' mean and half difference and the direction of the larger one.
static void invert(map_values_t* v, int32_t mean_q30, int32_t half_q30) {
  const int32_t small = tensor_inductance_q20(qc_add_sat(mean_q30, half_q30));
  const int32_t large = tensor_inductance_q20(qc_sub_sat(mean_q30, half_q30));
  const int32_t middle = small / 2 + large / 2;
  const int32_t half = qc_sub_sat(large, small) / 2;
  const rotation_t twice = frame_rotation((uint32_t)v->turn_bam * 2u);
  v->ldd_q20 = qc_sub_sat(middle, qc_mul(half, twice.cos_q30, 30));
  v->lqq_q20 = qc_add_sat(middle, qc_mul(half, twice.cos_q30, 30));
  v->ldq_q20 = -qc_mul(half, twice.sin_q30, 30);
}

bool solve_is_near(int32_t value, int32_t other, int32_t factor) {
  return value / factor <= other && value >= other / factor;
}

int32_t map_along(int32_t from, int32_t to, int32_t share_q24) {
  return qc_add_sat(from, qc_mul_sat(qc_sub_sat(to, from), share_q24, 24));
}

void map_refer(map_values_t* v, const map_values_t* below, int32_t current_q20) {
  if (v->current_q20 <= below->current_q20) return;
  const int32_t between_q20 = qc_sub_sat(v->current_q20, below->current_q20);
  const int32_t share_q24 = q_div(qc_sub_sat(current_q20, below->current_q20), between_q20, 24);
  v->ldd_q20 = map_along(below->ldd_q20, v->ldd_q20, share_q24);
  v->lqq_q20 = map_along(below->lqq_q20, v->lqq_q20, share_q24);
  v->ldq_q20 = map_along(below->ldq_q20, v->ldq_q20, share_q24);
}

map_values_t unsaturated_solve(const tensor_sums_t* s, const machine_model_t* m) {
  map_values_t v = {false, 0, 0, 0, 0, 0, 0, 0};
  tensor_axes_t a;
  if (!tensor_solve(s, m, &a) || a.half_q30 >= a.mean_q30) return v;
  invert(&v, a.mean_q30, axis_is_hidden(a.mean_q30, a.half_q30) ? 0 : a.half_q30);
  v.valid = true;
  return v;
}

bool map_smooth(int32_t ldq_q20[MAP_LEVELS], int32_t saliency_q20) {
  int32_t linear[MAP_LEVELS];
  int32_t cubic[MAP_LEVELS];
  int32_t value[MAP_LEVELS];
  int32_t largest = 0;
  fit_plane_t fit = {0, 0, 0};
  for (uint16_t k = 0; k < MAP_LEVELS; k++) {
    // The higher a level, the larger the turn that was read: weights 1, 2, 3, 4. Currents as a share of the largest.
    const int32_t n = (int32_t)k + 1;
    linear[k] = n * n * (1048576L / 4);
    cubic[k] = n * n * n * n * (1048576L / 64);
    value[k] = n * q_limit(ldq_q20[k], FIT_END / (int32_t)MAP_LEVELS);
    largest = q_max(largest, qc_abs_sat(ldq_q20[k]));
  }
  (void)fit_plane(linear, cubic, value, MAP_LEVELS, &fit);  // these two columns can be told apart
  const int32_t far_q20 = q_max(largest / 10, saliency_q20 / AXIS_PARTS);
  bool close = true;
  for (uint16_t k = 0; k < MAP_LEVELS; k++) {
    const int32_t n = (int32_t)k + 1;
    value[k] = qc_mul(fit.slope_q24, n * (1048576L / 4), 24) + qc_mul(fit.offset_q24, n * n * n * (1048576L / 64), 24);
    close = close && qc_abs_sat(qc_sub_sat(value[k], ldq_q20[k])) <= far_q20;
  }
  for (uint16_t k = 0; close && k < MAP_LEVELS; k++) ldq_q20[k] = value[k];
  return close;
}

bool map_repeats(const map_values_t* v) {
  return qc_abs_sat(v->apart_bam) <= q_max(qc_abs_sat(v->turn_bam) / 10, TENTH_DEGREE_BAM);
}

int32_t unsaturated_mismatch_q30(const tensor_sums_t* s, const machine_model_t* m) {
  tensor_axes_t a;
  if (!tensor_solve(s, m, &a)) return 0;
  return qc_mul_sat(q_div(a.across_q30, a.mean_q30, 30), SQRT3_Q28, 28);
}

map_values_t map_solve(const map_group_t group[MAP_GROUPS], const machine_model_t* m) {
  map_values_t v = {false, 0, 0, 0, 0, 0, 0, 0};
  int32_t axis[MAP_GROUPS];
  int32_t position[MAP_GROUPS];
  int32_t mean = 0;
  int32_t half = 0;
  for (uint16_t k = 0; k < MAP_GROUPS; k++) {
    tensor_axes_t a;
    if (!tensor_solve(&group[k].tensor, m, &a) || a.half_q30 >= a.mean_q30) return v;
    axis[k] = a.axis_bam;
    position[k] = over(group[k].position, group[k].tensor.count);
    mean += a.mean_q30 / (int32_t)MAP_GROUPS;
    half += a.half_q30 / (int32_t)MAP_GROUPS;
    v.current_q20 += qc_abs_sat(over(group[k].current, group[k].tensor.count)) / (int32_t)MAP_GROUPS;
  }
  // Groups 0 and 2 have i_q > 0, 1 and 3 i_q < 0; 2 and 3 are those of the mirrored train.
  const int32_t moved = (axis[0] - axis[2]) / 2 + (axis[1] - axis[3]) / 2;
  const int32_t predicted = qc_sub_sat(position[0], position[2]) / 2 + qc_sub_sat(position[1], position[3]) / 2;
  v.share_q24 = fit_ratio(moved, predicted, 24);
  v.turn_bam = (axis[0] - axis[1]) / 4 + (axis[2] - axis[3]) / 4;
  v.apart_bam = (axis[0] - axis[1]) / 4 - (axis[2] - axis[3]) / 4;
  invert(&v, mean, (qc_abs_sat(axis[0]) > EIGHTH_BAM) ? -half : half);  // Lqq may have sunk below Ldd
  v.valid = true;
  return v;
}

typedef struct {
  int32_t speed, voltage_q16, current_q20;
} steady_t;

// The voltage without that of the d-axis current. That of R i is taken off for the torque current as it was without
// one: where the reluctance adds to the torque or takes from it, that is a little more or less.
static steady_t steady(const spin_sums_t* s, int32_t ld_q30) {
  const int32_t flux_q28 = qc_mul_sat(ld_q30, over(s->current_d, s->periods), 22);
  const int32_t speed = over(s->speed, s->periods);
  const int32_t armature_q16 = fit_ratio((int64_t)flux_q28 * speed, BPP_PER_RAD_Q12, 0);
  const steady_t m = {speed, qc_sub_sat(over(s->voltage_q, s->periods), armature_q16),
                      over(s->current_q, s->torque_periods)};
  return m;
}

static int32_t emf_q16(const steady_t* s, int32_t resistance_q24) {
  return qc_sub_sat(s->voltage_q16, qc_mul_sat(resistance_q24, s->current_q20, 28));
}

static int32_t flux_q28(int32_t emf_q16, int32_t speed) { return over(emf_q16 * BPP_PER_RAD_Q12, speed); }

// Inertia from a ramp between two steady speeds, friction taken off as it is at those speeds.
static int32_t inertia_q24(const spin_sums_t* r, const steady_t* low, const steady_t* high, int32_t change,
                           int32_t torque_constant_q24, int32_t pole_pairs) {
  const int32_t mean_speed = over(r->speed, r->periods);
  const int32_t place_q24 = fit_ratio((int64_t)mean_speed - low->speed, (int64_t)high->speed - low->speed, 24);
  const int32_t friction_q20 = map_along(low->current_q20, high->current_q20, place_q24);
  const int32_t net_q20 = qc_sub_sat(over(r->current_q, r->periods), friction_q20);
  const int32_t torque_q24 = qc_mul_sat(torque_constant_q24, net_q20, 20);
  const int32_t impulse_q10 = qc_mul_sat(torque_q24, r->periods, 14);  // N m periods
  return fit_ratio(impulse_q10 * BPP_PER_ACCEL_Q16 * pole_pairs, change, -2);
}

spin_values_t spin_solve(const spin_t* s, int32_t resistance_q24, int32_t ld_q30, int32_t pole_pairs) {
  spin_values_t v = {false, 0, 0, 0, 0, 0, 0};
  for (uint16_t k = 0; k < SPIN_STATIONS; k++) {
    if (s->station[k].periods == 0) return v;
  }
  const steady_t low = steady(&s->station[0], ld_q30);
  const steady_t high = steady(&s->station[1], ld_q30);
  const steady_t end = steady(&s->station[2], ld_q30);
  const int32_t change = qc_sub_sat(high.speed, low.speed);
  if (change <= 0 || s->ramp[0].periods == 0 || s->ramp[1].periods == 0) return v;
  const int32_t current_q20 = qc_sub_sat(high.current_q20, low.current_q20);
  const int32_t low_emf_q16 = emf_q16(&low, resistance_q24);
  v.flux_q28 = flux_q28(qc_sub_sat(emf_q16(&high, resistance_q24), low_emf_q16), change);
  v.flux_low_q28 = flux_q28(low_emf_q16, low.speed);
  const int32_t torque_constant_q24 = qc_mul_sat(v.flux_q28 / 16, 3 * pole_pairs, 1);
  const int32_t torque_q20 = qc_mul_sat(torque_constant_q24, current_q20, 24);
  v.friction_q24 = over(torque_q20 * BPP_PER_RAD_Q4 * pole_pairs, change);
  v.inertia_up_q24 = inertia_q24(&s->ramp[0], &low, &high, change, torque_constant_q24, pole_pairs);
  v.inertia_down_q24 =
      inertia_q24(&s->ramp[1], &end, &high, qc_sub_sat(end.speed, high.speed), torque_constant_q24, pole_pairs);
  v.inertia_q24 = v.inertia_up_q24 / 2 + v.inertia_down_q24 / 2;
  v.valid = true;
  return v;
}

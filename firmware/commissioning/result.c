#include "firmware/commissioning/result.h"

#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"
#include "hal/qmath/qcall.h"

#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) ID_##name = id,
enum {
#include "firmware/dictionary/all_parameters.h"
  ID_NONE = 0
};
#undef PARAMETER

#define RMS_MAX_Q16 16384L          // 0.25 V: what a level may lie off the fitted line
#define DROP_CHANGE_MAX_Q16 98304L  // 1.5 V
#define EDGE_CHANGE_MAX_Q16 65536L  // 1 us
#define TURN_MAX_BAM 357913941L     // 30 degrees: beyond that next to no saliency is left
#define SALIENCY_SHARE 8            // nor with less than an eighth of it
#define CURRENT_SHARE 5             // a level's current is met within a fifth
#define LEAD_Q8 1229                // some 4.8 steps: (1 - exp(-12 aT))/aT with a bandwidth a of 1800 rad/s

static commissioning_verdict_t worst(commissioning_verdict_t a, commissioning_verdict_t b) {
  return (a != VERDICT_USED) ? a : b;
}

// Within a factor of the value so far, which comes from the nameplate.
static commissioning_verdict_t near(int32_t value, int32_t before, int32_t factor) {
  return solve_is_near(value, before, factor) ? VERDICT_USED : VERDICT_NAMEPLATE;
}

static commissioning_verdict_t agree(int32_t a, int32_t b, int32_t parts) {
  return (qc_abs_sat(qc_sub_sat(a, b)) > qc_abs_sat(a) / parts) ? VERDICT_INCONSISTENT : VERDICT_USED;
}

// What the functions below offer, each once: three of the staircase, three unsaturated, the map, that it is known and
// up to where the saliency is there, three of the spin.
#if 3u + 3u + 1u + 3u * MAP_LEVELS + 2u + 3u > COMMISSIONING_RESULTS
#error "a report has no room for its results"
#endif

// Places in the report of what others rest on: the functions below offer in this order.
enum { AT_RESISTANCE = 0, AT_DROP = 1, AT_DELAY = 2, AT_SENSORS = 5 };

// What has been refused stays so for the first reason.
static void conclude(commissioning_result_t* out, int32_t value, commissioning_verdict_t verdict) {
  const bool allowed = parameter_allows(parameter_by_id(out->id), value);
  out->value = value;
  out->verdict = worst(out->verdict, worst(verdict, allowed ? VERDICT_USED : VERDICT_RANGE));
}

static void offer(commissioning_report_t* r, uint16_t id, int32_t value, commissioning_verdict_t verdict) {
  commissioning_result_t* const out = &r->list[r->count++];
  out->id = id;
  out->before = parameter_get(id);
  out->verdict = VERDICT_USED;
  conclude(out, value, verdict);
}

// Whether all from one place of the report on are in use.
static bool all_used(const commissioning_report_t* r, uint16_t first) {
  for (uint16_t k = first; k < r->count; k++) {
    if (r->list[k].verdict != VERDICT_USED) return false;
  }
  return true;
}

static void refuse_all(commissioning_report_t* r, uint16_t first) {
  for (uint16_t k = first; k < r->count; k++) r->list[k].verdict = worst(r->list[k].verdict, VERDICT_DEPENDS);
}

static commissioning_verdict_t judge_staircase(const staircase_values_t* v, commissioning_report_t* r) {
  const parameters_t* const p = &parameters;
  const commissioning_verdict_t measured = v->valid ? VERDICT_USED : VERDICT_NOT_MEASURED;
  const commissioning_verdict_t straight = (v->command_rms_q16 > RMS_MAX_Q16) ? VERDICT_SPREAD : VERDICT_USED;
  const commissioning_verdict_t quiet = (v->window_rms_q16 > RMS_MAX_Q16) ? VERDICT_SPREAD : VERDICT_USED;
  const int32_t winding = qc_sub_sat(v->resistance_q24, p->device_resistance);
  const commissioning_verdict_t resistance = worst(worst(measured, straight), near(winding, p->stator_resistance, 3));
  offer(r, ID_stator_resistance, winding, resistance);
  const bool big_drop = qc_abs_sat(v->drop_error_q16) > DROP_CHANGE_MAX_Q16;
  const commissioning_verdict_t drop = worst(worst(measured, quiet), big_drop ? VERDICT_NAMEPLATE : VERDICT_USED);
  offer(r, ID_device_drop, q_max(qc_add_sat(p->device_drop, v->drop_error_q16), 0), drop);  // there is none below
  // Volts over the link are a share of the period of 100 us.
  const int32_t edge_q16 = qc_mul_sat(q_div(v->edge_error_q16, v->link_q16, 16), 100L * 65536L, 16);
  const bool big_edge = qc_abs_sat(edge_q16) > EDGE_CHANGE_MAX_Q16;
  const commissioning_verdict_t edge = worst(worst(resistance, drop), big_edge ? VERDICT_NAMEPLATE : VERDICT_USED);
  offer(r, ID_turn_on_delay, qc_add_sat(p->turn_on_delay, edge_q16), edge);
  return resistance;
}

static commissioning_verdict_t judge_unsaturated(const map_values_t* v, int32_t mismatch_q30,
                                                 commissioning_report_t* r) {
  const parameters_t* const p = &parameters;
  const commissioning_verdict_t measured = v->valid ? VERDICT_USED : VERDICT_NOT_MEASURED;
  const uint16_t first = r->count;
  offer(r, ID_inductance_d, v->ldd_q20, worst(measured, near(v->ldd_q20, p->inductance_d, 2)));
  offer(r, ID_inductance_q, v->lqq_q20, worst(measured, near(v->lqq_q20, p->inductance_q, 2)));
  const bool both = all_used(r, first);
  if (!both) refuse_all(r, first);
  offer(r, ID_sensor_mismatch, qc_mul_sat(mismatch_q30, 100L, 14), measured);  // percent, Q16
  return both ? VERDICT_USED : VERDICT_DEPENDS;
}

static int32_t percent_q16(int32_t part, int32_t whole) {
  return qc_mul_sat(q_div(part, whole, 24), 100L * 65536L, 24);
}

static void judge_level(const map_values_t* v, const map_values_t* zero, uint16_t level, int32_t level_q20,
                        commissioning_verdict_t unsaturated, commissioning_report_t* r) {
  const commissioning_verdict_t measured = v->valid ? VERDICT_USED : VERDICT_NOT_MEASURED;
  const commissioning_verdict_t current = agree(level_q20, v->current_q20, CURRENT_SHARE);
  const bool singular = v->ldd_q20 <= 0 || v->lqq_q20 <= 0 || qc_abs_sat(v->turn_bam) > TURN_MAX_BAM;
  commissioning_verdict_t all = worst(measured, singular ? VERDICT_NOT_PHYSICAL : VERDICT_USED);
  all = worst(all, (current == VERDICT_USED) ? VERDICT_USED : VERDICT_NOT_MEASURED);
  all = worst(all, unsaturated);
  offer(r, (uint16_t)(ID_lqq_1 + level), percent_q16(v->lqq_q20, zero->lqq_q20), all);
  offer(r, (uint16_t)(ID_ldd_1 + level), percent_q16(v->ldd_q20, zero->ldd_q20), all);
  offer(r, (uint16_t)(ID_ldq_1 + level), v->ldq_q20, all);
}

// The levels are shares of the map's last current: with another one than before, all of them or none; of a map that
// ends early some of the points rest on two levels. A saliency that stays says nothing of the current: 0.
static void keep_map_together(commissioning_report_t* r, uint16_t first, bool ends) {
  const commissioning_result_t* const last = &r->list[first];
  const commissioning_verdict_t all = all_used(r, first) ? VERDICT_USED : VERDICT_DEPENDS;
  if (all != VERDICT_USED && (ends || last->value != last->before)) refuse_all(r, first);
  offer(r, ID_map_known, 1, all);
  offer(r, ID_saliency_current, ends ? last->value : 0, all);
}

static bool has_lost_saliency(const map_values_t* v, int32_t saliency_q20) {
  const int32_t least_q20 = saliency_q20 / SALIENCY_SHARE;
  return v->valid && (qc_sub_sat(v->lqq_q20, v->ldd_q20) < least_q20 || qc_abs_sat(v->turn_bam) > TURN_MAX_BAM);
}

static map_values_t at_level(const commissioning_t* c, const map_values_t* zero, uint16_t level) {
  map_values_t v = map_solve(c->map.group[level], &c->model);
  const map_values_t below = (level == 0u) ? *zero : map_solve(c->map.group[level - 1u], &c->model);
  map_refer(&v, &below, map_level_q20(&c->map, level));
  return v;
}

// The slope that is fed forward is one of the inductance without current; where saturation leaves less of it the
// current gets ahead of its plan. It stays below the trip; 1/Lqq rises on with the square of the current.
static int32_t slope_q20(const map_t* m, int32_t zero_q20, int32_t lqq_q20) {
  const int32_t from = (int32_t)m->level + 1;
  const int32_t to = q_min(from + 1, (int32_t)MAP_LEVELS);
  const int32_t steeper_q24 = q_div(qc_sub_sat(zero_q20, lqq_q20), lqq_q20, 24);
  const int32_t steps_q24 = q_max(qc_mul_sat(steeper_q24, LEAD_Q8 * to * to / (from * from), 8), 1);
  return q_div(parameters.trip_current - map_level_q20(m, (uint16_t)(to - 1)), steps_q24, 24);
}

// Of the level that is being measured; the nameplate's saliency has to do, for the pauses still add to the other.
bool commissioning_judge_level(commissioning_t* c) {
  const map_values_t zero = unsaturated_solve(&c->unsaturated, &c->model);
  const map_values_t v = at_level(c, &zero, c->map.level);
  c->map.slope_q20 = slope_q20(&c->map, zero.lqq_q20, v.lqq_q20);
  return has_lost_saliency(&v, parameters.inductance_q - parameters.inductance_d);
}

// The map's points up to the last level with saliency, between the measured ones on straight lines, as the flux takes
// the inductances (machine_map.c). From the last one down: a point lies below the levels that it is made of.
static void end_map(commissioning_result_t* map, uint16_t salient, int32_t current_q20) {
  conclude(map, current_q20, VERDICT_USED);
  for (uint16_t point = MAP_LEVELS; point > 0u; point--) {
    const uint16_t place = (uint16_t)(point * salient);
    const int32_t share_q24 = (int32_t)(place % MAP_LEVELS) * (16777216L / (int32_t)MAP_LEVELS);
    const commissioning_result_t* const above = &map[place / MAP_LEVELS * 3u];
    for (uint16_t column = 1; column <= 3u; column++) {
      const int32_t none = (column < 3u) ? 100L * 65536L : 0;
      const int32_t from = (place < MAP_LEVELS) ? none : map[place / MAP_LEVELS * 3u - 3u + column].value;
      commissioning_result_t* const out = &map[3u * (point - 1u) + column];
      out->value = map_along(from, above[column].value, share_q24);
      if (point > salient) out->verdict = VERDICT_USED;
    }
  }
}

static void judge_map(const commissioning_t* c, const map_values_t* zero, commissioning_verdict_t unsaturated,
                      commissioning_report_t* r) {
  const uint16_t first = r->count;
  const int32_t saliency_q20 = qc_sub_sat(zero->lqq_q20, zero->ldd_q20);
  offer(r, ID_map_current, parameters.current_limit, VERDICT_USED);
  uint16_t salient = 0;
  bool repeats = true;
  for (uint16_t k = 0; k < MAP_LEVELS; k++) {
    const map_values_t v = at_level(c, zero, k);
    judge_level(&v, zero, k, map_level_q20(&c->map, k), unsaturated, r);
    if (k >= c->map.levels || has_lost_saliency(&v, saliency_q20)) continue;
    salient = (uint16_t)(k + 1u);
    repeats = repeats && map_repeats(&v);
  }
  const bool early = salient < MAP_LEVELS || c->map.most_q20 < parameters.current_limit;
  const bool ends = early && salient >= SALIENT_LEAST;
  if (ends) end_map(&r->list[first], salient, map_level_q20(&c->map, (uint16_t)(salient - 1u)));
  int32_t ldq_q20[MAP_LEVELS];
  for (uint16_t k = 0; k < MAP_LEVELS; k++) {
    ldq_q20[k] = r->list[first + 3u * (k + 1u)].value;
    repeats = repeats && (ldq_q20[k] ^ ldq_q20[0]) >= 0;  // of one sign
  }
  // Cross-saturation ends: where the iron is full the curve is no cubic, but what is seen twice is none of the noise.
  const bool smooth = map_smooth(ldq_q20, saliency_q20) || repeats;
  for (uint16_t k = 0; k < MAP_LEVELS; k++) {
    conclude(&r->list[first + 3u * (k + 1u)], ldq_q20[k], smooth ? VERDICT_USED : VERDICT_SPREAD);
  }
  keep_map_together(r, first, ends);
}

void commissioning_solve_motion(commissioning_t* c) {
  const spin_values_t v = spin_solve(&c->spin, c->model.rs_q24, c->model.ld_q30, parameters.pole_pairs);
  const int32_t inertia_q24 = v.inertia_q24;
  c->torque_q24 = c->model.torque_q24;
  c->accel_q12 = c->model.accel_q12;
  if (!solve_is_near(v.flux_q28, c->model.flux_q28, 2)) return;  // one that was not found is 0
  if (inertia_q24 <= 0 || !solve_is_near(inertia_q24, parameters.inertia, 20)) return;
  c->torque_q24 = qc_mul_sat(c->model.torque_q24, q_div(v.flux_q28, c->model.flux_q28, 24), 24);
  c->accel_q12 = qc_mul_sat(c->model.accel_q12, q_div(parameters.inertia, inertia_q24, 24), 24);
}

// Flux over inertia, from how far the torque trains moved the shaft, is a second way to the inertia.
static int32_t inertia_from_trains(const commissioning_t* c, int32_t inertia_q24) {
  const map_values_t top = map_solve(c->map.group[q_max(c->map.levels, 1) - 1], &c->model);
  const int32_t moved_q24 = q_max(qc_add_sat(16777216L, top.share_q24), 1);
  return q_div(inertia_q24, moved_q24, 24);
}

static void judge_spin(const commissioning_t* c, commissioning_verdict_t resistance, commissioning_report_t* r) {
  const parameters_t* const p = &parameters;
  const int32_t winding = (resistance == VERDICT_USED) ? r->list[AT_RESISTANCE].value : p->stator_resistance;
  const int32_t resistance_q24 = qc_add_sat(winding, p->device_resistance);
  const spin_values_t v = spin_solve(&c->spin, resistance_q24, c->model.ld_q30, parameters.pole_pairs);
  const commissioning_verdict_t measured = v.valid ? VERDICT_USED : VERDICT_NOT_MEASURED;
  commissioning_verdict_t flux = worst(measured, agree(v.flux_q28, v.flux_low_q28, 10));
  flux = worst(flux, (v.flux_q28 <= 0) ? VERDICT_NOT_PHYSICAL : near(v.flux_q28, p->magnet_flux, 2));
  offer(r, ID_magnet_flux, v.flux_q28, flux);
  const int32_t inertia_q24 = v.inertia_q24;
  commissioning_verdict_t inertia = worst(measured, agree(v.inertia_up_q24, v.inertia_down_q24, 5));
  if (!c->uniform) inertia = worst(inertia, agree(inertia_q24, inertia_from_trains(c, inertia_q24), 4));
  inertia = worst(inertia, (inertia_q24 <= 0) ? VERDICT_NOT_PHYSICAL : near(inertia_q24, p->inertia, 20));
  if (flux != VERDICT_USED) inertia = worst(inertia, VERDICT_DEPENDS);
  offer(r, ID_inertia, inertia_q24, inertia);
  offer(r, ID_friction, v.friction_q24, worst(inertia, (v.friction_q24 < 0) ? VERDICT_NOT_PHYSICAL : VERDICT_USED));
}

void commissioning_judge(const commissioning_t* c, commissioning_report_t* report) {
  report->count = 0;
  const staircase_values_t stairs = staircase_solve(&c->staircase, &c->model);
  const map_values_t zero = unsaturated_solve(&c->unsaturated, &c->model);
  const int32_t beyond_q30 = unsaturated_mismatch_q30(&c->unsaturated, &c->model);
  const int32_t mismatch_q30 = qc_add_sat(c->mismatch_q30, beyond_q30);
  const commissioning_verdict_t resistance = judge_staircase(&stairs, report);
  const commissioning_verdict_t unsaturated = judge_unsaturated(&zero, mismatch_q30, report);
  if (c->uniform) {
    offer(report, ID_start_method, 1, VERDICT_USED);
  } else {
    judge_map(c, &zero, unsaturated, report);
  }
  judge_spin(c, resistance, report);
  // Currents that are measured wrong spoil everything.
  if (report->list[AT_SENSORS].verdict != VERDICT_USED) refuse_all(report, 0);
}

static void take_back(const commissioning_report_t* r, uint16_t from, uint16_t to) {
  for (uint16_t k = from; k < to; k++) (void)parameter_set(r->list[k].id, r->list[k].before);
}

// Values that pass one by one may still not fit together. What the edges lose is split between the devices' drop and
// their delay, the less surely the lower the link: a delay that leaves none of the dead time is a split that failed,
// and nothing else rests on it. Otherwise none of the values is used.
commissioning_outcome_t commissioning_use(commissioning_report_t* r) {
  for (uint16_t k = 0; k < r->count; k++) {
    if (r->list[k].verdict == VERDICT_USED) (void)parameter_set(r->list[k].id, r->list[k].value);
  }
  if (parameter_conflict() != PACKED_NONE) {
    take_back(r, AT_DROP, AT_DELAY + 1);
    if (parameter_conflict() == PACKED_NONE) {
      r->list[AT_DELAY].verdict = VERDICT_RANGE;
      r->list[AT_DROP].verdict = VERDICT_DEPENDS;
    } else {
      take_back(r, 0, r->count);
      refuse_all(r, 0);
    }
  }
  return all_used(r, 0) ? COMMISSIONING_DONE : COMMISSIONING_PARTLY;
}

// What the background level makes of a commissioning: with any sums at all, more than the sequence can give, any counts
// and any parameters. Of the model, only that there are 1 to 20 pole pairs.

#include "firmware/commissioning/phases.h"
#include "firmware/commissioning/result.h"
#include "firmware/config/rules.h"
#include "firmware/mode/mode.h"
#include "tests/prove/any_parameters.h"

bool drive_is_energised(void) { return any_bool(); }
void drive_parameters_changed(void) {}
packed_text_t parameter_conflict(void) { return any_bool() ? PACKED_NONE : any_up_to(PACKED_NONE - 1u); }

static commissioning_t c;
static commissioning_report_t report;

static void any_staircase(staircase_t* s) {
  for (uint16_t k = 0; k < STAIRCASE_LEVELS; k++) {
    const staircase_level_t l = {any_i64, any_i64, any_i64, any_i64, any_i64, any_i32, any_i32, any_i32};
    s->level[k] = l;
  }
}

static tensor_sums_t any_tensor(void) {
  const tensor_sums_t s = {any_i64, any_i64, any_i64, any_i64, any_i64, any_i64, any_i64, any_i32};
  return s;
}

int32_t map_level_q20(const map_t* m, uint16_t level) {
  (void)level;
  return any_from(q_min(m->most_q20, 0), q_max(m->most_q20, 0));
}

static void any_map(map_t* m) {
  for (uint16_t level = 0; level < MAP_LEVELS; level++) {
    for (uint16_t k = 0; k < MAP_GROUPS; k++) {
      const map_group_t g = {any_tensor(), any_i64, any_i64};
      m->group[level][k] = g;
    }
  }
}

static void any_spin(spin_t* s) {
  for (uint16_t k = 0; k < SPIN_STATIONS; k++) {
    const spin_sums_t station = {any_i64, any_i64, any_i64, any_i64, any_i32, any_i32};
    s->station[k] = station;
  }
  for (uint16_t k = 0; k < SPIN_RAMPS; k++) {
    const spin_sums_t ramp = {any_i64, any_i64, any_i64, any_i64, any_i32, any_i32};
    s->ramp[k] = ramp;
  }
}

static void any_constants(machine_model_t* m) {
  m->rs_q24 = any_i32;
  m->ld_q30 = any_i32;
  m->flux_q28 = any_i32;
  m->torque_q24 = any_i32;
  m->accel_q12 = any_i32;
  m->yd_q30 = any_i32;
  m->yq_q30 = any_i32;
}

void prove_results(void) {
  any_parameters();
  any_staircase(&c.staircase);
  c.unsaturated = any_tensor();
  any_map(&c.map);
  any_spin(&c.spin);
  any_constants(&c.model);
  c.mismatch_q30 = any_i32;
  commissioning_solve_motion(&c);
  commissioning_judge(&c, &report);
  (void)commissioning_use(&report);
}

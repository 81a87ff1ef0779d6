#include "svpwm/dead_time.h"

#include "svpwm/ripple.h"

// Sign of a current as -1..1, Q15, linear inside the band.
static int32_t sign_q15(const dead_time_config_t* c, int32_t current_q20) {
  if (current_q20 >= c->band_q20) return 32767L;
  if (current_q20 <= -c->band_q20) return -32767L;
  return q_mul_floor(current_q20, c->per_band_q29, 29);
}

// Delay of an edge, ticks; `sign` is positive where the current blocks the edge.
static int16_t delay_ticks(const dead_time_config_t* c, int32_t blocking_q15) {
  const int32_t middle = c->blocked_ticks + c->released_ticks;
  const int32_t half_range = c->blocked_ticks - c->released_ticks;
  return (int16_t)q_shr_round(middle * (int32_t)32768 + half_range * blocking_q15, 16);
}

void dead_time_design(dead_time_config_t* c) {
  c->per_band_q29 = q_div(32768L, c->band_q20, 29);
  c->third_drop_q24 = q_div(c->drop_q16, 3, 8);
  c->side_drop_q24 = q_mul(c->drop_q16, FRAME_SQRT3_INV_Q30, 22);
}

static dead_time_edges_t edge_bit(bool uncertain, uint16_t bit) {
  return uncertain ? (dead_time_edges_t)(1u << bit) : 0u;
}

dead_time_edges_t dead_time_compensate(const dead_time_config_t* c, const svpwm_pulses_t* wanted, ab_t current_q20,
                                       int32_t admittance_q30, int32_t link_q16, svpwm_pulses_t* command) {
  const abc_t mean = frame_inverse_clarke(current_q20);
  const int32_t mean_q20[SVPWM_LEGS] = {mean.a, mean.b, mean.c};
  dead_time_edges_t uncertain = 0;
  svpwm_edges_t ripple;
  svpwm_edge_ripple_q20(wanted, admittance_q30, link_q16, &ripple);
  for (uint16_t leg = 0; leg < SVPWM_LEGS; leg++) {
    const int32_t at_rise = mean_q20[leg] + ripple.rise_q20[leg];
    const int32_t at_fall = mean_q20[leg] + ripple.fall_q20[leg];
    command->rise[leg] = (int16_t)(wanted->rise[leg] - delay_ticks(c, sign_q15(c, at_rise)));
    command->fall[leg] = (int16_t)(wanted->fall[leg] - delay_ticks(c, -sign_q15(c, at_fall)));
    uncertain |= edge_bit(q_abs_sat(at_rise) < c->edge_band_q20, leg);
    uncertain |= edge_bit(q_abs_sat(at_fall) < c->edge_band_q20, (uint16_t)(SVPWM_LEGS + leg));
  }
  return uncertain;
}

// An uncertain edge: where it is wanted at the motor, and where it comes at the latest and at the earliest.
typedef struct {
  int16_t wanted, latest, earliest;
} guard_t;

static uint16_t guards_of(const dead_time_config_t* c, const svpwm_pulses_t* wanted, const svpwm_pulses_t* command,
                          dead_time_edges_t uncertain, guard_t guards[2 * SVPWM_LEGS]) {
  uint16_t count = 0;
  for (uint16_t leg = 0; leg < SVPWM_LEGS; leg++) {
    if (((uint32_t)uncertain >> leg & 1u) != 0u) {
      const int16_t at = command->rise[leg];
      const guard_t g = {wanted->rise[leg], (int16_t)(at + c->blocked_ticks), (int16_t)(at + c->released_ticks)};
      guards[count++] = g;
    }
    if (((uint32_t)uncertain >> (SVPWM_LEGS + leg) & 1u) != 0u) {
      const int16_t at = command->fall[leg];
      const guard_t g = {wanted->fall[leg], (int16_t)(at + c->blocked_ticks), (int16_t)(at + c->released_ticks)};
      guards[count++] = g;
    }
  }
  return count;
}

static svpwm_window_t guarded(const guard_t guards[], uint16_t count, const svpwm_window_t* window) {
  svpwm_window_t w = *window;
  for (uint16_t k = 0; k < count; k++) {
    const guard_t* const g = &guards[k];
    if (g->wanted == window->begin) w.begin = q_max16(w.begin, g->latest);
    if (g->wanted == window->end) w.end = q_min16(w.end, g->earliest);
  }
  return w;
}

void dead_time_guard_windows(const dead_time_config_t* c, const sampling_config_t* sampling,
                             const svpwm_pulses_t* command, dead_time_edges_t uncertain, svpwm_pattern_t* pattern) {
  if (uncertain == 0u) return;
  guard_t guards[2 * SVPWM_LEGS];
  const uint16_t edges = guards_of(c, &pattern->pulses, command, uncertain, guards);
  uint16_t count = 0;
  for (uint16_t k = 0; k < pattern->window_count; k++) {
    const svpwm_window_t w = guarded(guards, edges, &pattern->windows[k]);
    if (svpwm_burst_end(sampling, &w) - svpwm_burst_start(sampling, &w) < sampling->span_min_ticks) continue;
    pattern->windows[count] = w;
    count++;
  }
  pattern->window_count = count;
}

ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20) {
  const abc_t i = frame_inverse_clarke(current_q20);
  const int32_t a = sign_q15(c, i.a);
  const int32_t b = sign_q15(c, i.b);
  const int32_t s = sign_q15(c, i.c);
  const ab_t drop = {q_mul_floor(2 * a - b - s, c->third_drop_q24, 23), q_mul_floor(b - s, c->side_drop_q24, 23)};
  return drop;
}

#include "svpwm/dead_time.h"

#include "svpwm/ripple.h"

#define RISE_BIT 1u  // of leg 0 in dead_time_edges_t
#define FALL_BIT (1u << SVPWM_LEGS)

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
  c->blocked_delay_ticks = delay_ticks(c, 32767L);
  c->released_delay_ticks = delay_ticks(c, -32767L);
}

// Shift of an edge; a positive current blocks it.
static int16_t rise_shift(const dead_time_config_t* c, int32_t current_q20) {
  if (current_q20 >= c->band_q20) return c->blocked_delay_ticks;
  if (current_q20 <= -c->band_q20) return c->released_delay_ticks;
  return delay_ticks(c, sign_q15(c, current_q20));
}

// A positive current brings it about.
static int16_t fall_shift(const dead_time_config_t* c, int32_t current_q20) {
  if (current_q20 >= c->band_q20) return c->released_delay_ticks;
  if (current_q20 <= -c->band_q20) return c->blocked_delay_ticks;
  return delay_ticks(c, -sign_q15(c, current_q20));
}

static bool is_uncertain(const dead_time_config_t* c, int32_t current_q20) {
  return current_q20 < c->edge_band_q20 && current_q20 > -c->edge_band_q20;
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
    command->rise[leg] = (int16_t)(wanted->rise[leg] - rise_shift(c, at_rise));
    command->fall[leg] = (int16_t)(wanted->fall[leg] - fall_shift(c, at_fall));
    if (is_uncertain(c, at_rise)) uncertain = (dead_time_edges_t)(uncertain | RISE_BIT << leg);
    if (is_uncertain(c, at_fall)) uncertain = (dead_time_edges_t)(uncertain | FALL_BIT << leg);
  }
  return uncertain;
}

// The windows that begin or end at an uncertain edge. `found` says where they were before the first such edge.
static void guard_edge(const dead_time_config_t* c, int16_t wanted, int16_t command, const svpwm_window_t found[],
                       svpwm_pattern_t* pattern) {
  for (uint16_t k = 0; k < pattern->window_count; k++) {
    svpwm_window_t* const w = &pattern->windows[k];
    if (wanted == found[k].begin) w->begin = q_max16(w->begin, (int16_t)(command + c->blocked_ticks));
    if (wanted == found[k].end) w->end = q_min16(w->end, (int16_t)(command + c->released_ticks));
  }
}

static void drop_short(const sampling_config_t* sampling, svpwm_pattern_t* pattern) {
  uint16_t count = 0;
  for (uint16_t k = 0; k < pattern->window_count; k++) {
    const svpwm_window_t* const w = &pattern->windows[k];
    if (svpwm_burst_end(sampling, w) - svpwm_burst_start(sampling, w) < sampling->span_min_ticks) continue;
    if (count < k) pattern->windows[count] = *w;
    count++;
  }
  pattern->window_count = count;
}

void dead_time_guard_windows(const dead_time_config_t* c, const sampling_config_t* sampling,
                             const svpwm_pulses_t* command, dead_time_edges_t uncertain, svpwm_pattern_t* pattern) {
  const svpwm_pulses_t* const wanted = &pattern->pulses;
  if (uncertain == 0u) return;
  const svpwm_window_t found[SVPWM_WINDOWS] = {pattern->windows[0], pattern->windows[1], pattern->windows[2]};
  for (uint16_t leg = 0; leg < SVPWM_LEGS; leg++) {
    const uint32_t of_leg = (uint32_t)uncertain >> leg;
    if ((of_leg & RISE_BIT) != 0u) guard_edge(c, wanted->rise[leg], command->rise[leg], found, pattern);
    if ((of_leg & FALL_BIT) != 0u) guard_edge(c, wanted->fall[leg], command->fall[leg], found, pattern);
  }
  drop_short(sampling, pattern);
}

ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20) {
  const abc_t i = frame_inverse_clarke(current_q20);
  const int32_t a = sign_q15(c, i.a);
  const int32_t b = sign_q15(c, i.b);
  const int32_t s = sign_q15(c, i.c);
  const ab_t drop = {q_mul_floor(2 * a - b - s, c->third_drop_q24, 23), q_mul_floor(b - s, c->side_drop_q24, 23)};
  return drop;
}

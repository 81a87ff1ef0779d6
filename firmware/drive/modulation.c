// From the voltage command to the compare registers.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/interfaces/phase_control.h"
#include "firmware/mode/mode.h"
#include "hal/hal_profile.h"
#include "hal/hal_pwm.h"

#define DEADLINE_TICK 9700u  // later than this in the period nothing is written

// Two windows want vectors that have the mean voltage between them (config.c).
static excitation_t by_windows(const drive_t* d) {
  return (d->config.modulator.sampling.windows < SVPWM_WINDOWS) ? EXCITATION_CHEAPEST : EXCITATION_ALTERNATING;
}

static excitation_t excitation(const drive_t* d) {
  if (d->state == DRIVE_START || d->state == DRIVE_COMMISSION) return by_windows(d);
  if (d->config.values.excitation != EXCITATION_BY_SOURCE) return (excitation_t)d->config.values.excitation;
  const position_source_t* const source = d->source;
  return (source->excitation == NULL) ? by_windows(d) : source->excitation(d);
}

// All lower devices on for the whole period, and three windows in it.
static svpwm_pattern_t short_circuit(const sampling_config_t* c) {
  const svpwm_pattern_t p = {{{-1, -1, -1, -1, -1, -1}, {0, 0, 0, 0, 0, 0}},
                             {svpwm_window_between(c, 0, 3300, 0),
                              svpwm_window_between(c, 3300, 6600, 0),
                              svpwm_window_between(c, 6600, SVPWM_PERIOD_TICKS, 0),
                              {0, 0, 0}},
                             SVPWM_WINDOWS};
  return p;
}

static const hal_pwm_frame_t no_pulses = {
    {HAL_PWM_NONE, HAL_PWM_NONE, HAL_PWM_NONE, HAL_PWM_NONE, HAL_PWM_NONE, HAL_PWM_NONE},
    {HAL_PWM_NONE, HAL_PWM_NONE, HAL_PWM_NONE},
    {HAL_PWM_NONE, HAL_PWM_NONE, HAL_PWM_NONE}};

// The pattern made now acts in the next period: one and a half periods from the angle's instant to its middle.
static uint32_t angle_at_action(const drive_t* d) {
  const int32_t speed = d->estimate.selected.speed_bpp;
  return d->estimate.selected.angle_bam + (uint32_t)(speed + speed / 2);
}

// Written out, three times, rather than as a loop.
static inline void put_window(hal_pwm_frame_t* f, const svpwm_pattern_t* p, uint16_t k) {
  const bool used = k < p->window_count;
  f->burst_start_tick[k] = used ? (uint16_t)p->windows[k].start : HAL_PWM_NONE;
  f->burst_end_tick[k] = used ? (uint16_t)p->windows[k].end : HAL_PWM_NONE;
}

// What was told too late leaves the pattern that runs for another period.
static void write_frame(drive_modulation_t* m, hal_pwm_frame_t* f, uint16_t made) {
  const svpwm_pattern_t* const p = &m->patterns[made];
  put_window(f, p, 0u);
  put_window(f, p, 1u);
  put_window(f, p, 2u);
  const bool written = hal_pwm_write(f, DEADLINE_TICK);
  m->sampled = m->running;
  if (written) {
    m->running = made;
    m->overrun = 0;
  } else {
    m->overrun++;
    m->limits |= (uint16_t)LIMIT_OVERRUN;
  }
}

void drive_modulation_reset(drive_modulation_t* m) {
  m->sampled = 0;
  m->running = 0;
  modulator_reset(&m->state);
}

// The voltage command's pattern, and the instants of its edges.
static void modulate(const drive_t* d, drive_modulation_t* m, current_controller_t* current, svpwm_pattern_t* pattern,
                     hal_pwm_frame_t* f) {
  const rotation_t r = frame_rotation(angle_at_action(d));
  const abc_t shares_q12 = dead_time_shares_q12(&d->config.dead_time, frame_back(d->estimate.measured_q20, r));
  const ab_t drop_q16 = dead_time_drop_of_q16(&d->config.dead_time, shares_q12);
  const ab_t reference_q16 = frame_back(d->control.command_q16, r);
  const ab_t command_q16 = {reference_q16.alpha + drop_q16.alpha, reference_q16.beta + drop_q16.beta};
  m->command_q16 = command_q16;
  const modulator_result_t result = modulator_step(&m->state, &d->config.modulator, excitation(d), command_q16,
                                                   d->samples.link_q16, &pattern->pulses);
  if (result.limited && d->control.references.closed) {
    const ab_t excess_q16 = {command_q16.alpha - result.realised_q16.alpha,
                             command_q16.beta - result.realised_q16.beta};
    current_controller_limited(current, &d->config.current, frame_park(excess_q16, r));
    m->limits |= (uint16_t)LIMIT_VOLTAGE;
  }
  const svpwm_carried_t carried = {shares_q12, d->estimate.model.yd_q30 / 2 + d->estimate.model.yq_q30 / 2,
                                   d->samples.link_q16};
  svpwm_compensate_edges(&d->config.dead_time, &d->config.modulator.sampling, &carried, pattern, f->edge_tick);
}

static void modulate_into(const drive_t* d, drive_modulation_t* m, current_controller_t* current, uint16_t made) {
  svpwm_pattern_t* const pattern = &m->patterns[made];
  hal_pwm_frame_t f;
  if (d->flags.shorted) {
    *pattern = short_circuit(&d->config.modulator.sampling);
    f = no_pulses;
  } else {
    modulate(d, m, current, pattern, &f);
  }
  hal_profile_step(CYCLES_MODULATE);
  write_frame(m, &f, made);
}

// Into the pattern that does not run: a call for each of the two, as what is proved of one place is not of either.
void drive_modulate(const drive_t* d, drive_modulation_t* m, current_controller_t* current) {
  if (d->schedule.task == TASK_SPEED) m->limits = 0;
  if (edition_phase_control != NULL && edition_phase_control->step(d, m)) return;
  if (m->running == 0u) {
    modulate_into(d, m, current, 1u);
  } else {
    modulate_into(d, m, current, 0u);
  }
}

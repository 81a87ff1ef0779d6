// What opens the power stage: looked at in every period, before anything is commanded.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "hal/hal_pwm.h"

#define MISSING_MAX 5u   // periods without samples
#define OVERRUN_MAX 10u  // periods repeated because the interrupt was late
#define JUDGED_PERIODS_MAX 6L

// By the latest of the period's windows; within a period the comparator is there.
static bool over_current(const drive_t* d) {
  if (d->samples.count == 0u) return false;
  const abc_t i = frame_inverse_clarke(d->samples.windows[d->samples.count - 1u].current_q20);
  const int32_t limit = d->config.values.trip_current;
  return !(q_in_range(i.a, -limit, limit) && q_in_range(i.b, -limit, limit) && q_in_range(i.c, -limit, limit));
}

// How far the two estimators are apart; 0 where there is one, or one that says itself that it knows nothing.
static int32_t disagreement(const drive_t* d) {
  const drive_estimate_t* const p = &d->estimate;
  const bool both =
      drive_source_has(d, SOURCE_BESIDE) || (drive_source_has(d, SOURCE_BLENDS) && p->blend.region == BLEND_BOTH);
  if (!both || p->low.quality_q15 == 0 || p->high.quality_q15 == 0) return 0;
  return q_abs_sat(angle_diff_bam(p->low.angle_bam, p->high.angle_bam));
}

// The two estimators must agree wherever both are used, and no speed may be far beyond the largest reference.
static bool diverged(const drive_t* d, drive_supervision_t* v, int32_t periods, int32_t apart_bam) {
  const int32_t speed_limit = q_mul_floor(d->config.values.speed_limit, d->config.bpp_per_rpm_q8, 16);
  const bool wrong = (apart_bam > 0 && apart_bam > q_mul_floor(d->config.values.divergence_limit, 11930465L, 16)) ||
                     q_abs_sat(d->estimate.selected.speed_bpp) / 3 * 2 > speed_limit;
  v->diverged_periods = wrong ? (uint16_t)(v->diverged_periods + (uint16_t)periods) : 0u;
  return v->diverged_periods > (uint16_t)(d->config.values.divergence_time * DRIVE_PERIODS_PER_MS);
}

static int32_t span_of(const drive_samples_t* s) {
  int32_t span_ticks = 0;
  for (uint16_t k = 0; k < s->count; k++) span_ticks += s->windows[k].span_ticks;
  return span_ticks;
}

// An angle error that is asked for is none.
static bool lost_synchronism(const drive_t* d, drive_supervision_t* v, deviation_residual_t* left, int32_t periods,
                             int32_t ahead_bpp, int32_t apart_bam) {
  const bool measured = drive_source_has(d, SOURCE_MEASURES);
  const regression_t* const by_avv = &d->estimate.avv.regression;
  if (measured && d->estimate.selected.angle_bam != d->estimate.low.angle_bam) return false;
  synchronism_seen_t seen = {{0, 0}, 0, d->estimate.selected.speed_bpp, ahead_bpp, periods};
  // Where the observer reads the windows, its residuals say how it is: those of all periods since it was last asked.
  if (position_observer_reads(d)) {
    (void)deviation_take_mean_residual(left, &seen.residual_q20, &seen.span_ticks, &seen.periods);
  } else if (drive_source_has(d, SOURCE_ALTERNATES) && by_avv->information > 0) {
    seen.residual_q20 = by_avv->mean_q20;  // AVV has regressed the same windows
    seen.span_ticks = span_of(&d->samples);
  } else {
    synchronism_look(&seen, &d->estimate.model, d->samples.windows, d->samples.count, d->estimate.selected.angle_bam);
  }
  // AVV beside the encoder may stray where its windows are short; that is divergence, the encoder's angle stands.
  return synchronism_judge(&v->synchronism, &d->config.synchronism, &d->estimate.model, &seen,
                           measured ? 0 : apart_bam);
}

// In its slot only, where a period says what the next ones do, or the observer's residuals are those of all periods
// since; alternating pulses give each period windows of its own.
static bool judges_now(const drive_t* d) {
  return d->schedule.judges || (d->modulation.state.is_alternating && !position_observer_reads(d));
}

// How much faster the frame in use has turned than its speed says, since it was last judged; 0 when that is long ago.
static int32_t frame_ahead_bpp(const drive_t* d, int32_t since) {
  if ((uint32_t)(since - 1) >= JUDGED_PERIODS_MAX) return 0;
  const uint32_t by_speed_bam = (uint32_t)d->estimate.selected.speed_bpp * (uint32_t)since;
  return angle_diff_bam(d->estimate.selected.angle_bam, d->supervision.judged_bam + by_speed_bam) / since;
}

static drive_fault_t check_position(const drive_t* d, drive_supervision_t* v, deviation_residual_t* left) {
  const int32_t since = (uint16_t)(d->heartbeat - v->judged_at);
  const int32_t ahead_bpp = frame_ahead_bpp(d, since);
  const int32_t periods = q_min(since, JUDGED_PERIODS_MAX);
  v->judged_at = d->heartbeat;
  v->judged_bam = d->estimate.selected.angle_bam;
  const int32_t apart_bam = disagreement(d);
  if (lost_synchronism(d, v, left, periods, ahead_bpp, apart_bam))
    return polarity_watch_suspects() ? FAULT_POLARITY : FAULT_SYNCHRONISM;
  return diverged(d, v, periods, apart_bam) ? FAULT_DIVERGENCE : FAULT_NONE;
}

static drive_fault_t check(const drive_t* d, drive_supervision_t* v, deviation_residual_t* left) {
  // With the gates off a fast shaft may drive a current through the diodes; switching them on forgets that.
  const bool meant_off = d->flags.gates_off;
  if (!meant_off && hal_pwm_was_tripped_by_pin()) return FAULT_OVER_CURRENT;
  if (hal_pwm_is_tripped() && !meant_off) return interlock_why_off();
  if (v->missing > MISSING_MAX) return FAULT_NO_SAMPLES;
  if (d->modulation.overrun > OVERRUN_MAX) return FAULT_OVERRUN;
  if (over_current(d)) return FAULT_CURRENT_LIMIT;
  if (d->samples.link_q16 < d->config.values.link_minimum) return FAULT_LINK_LOW;
  if (d->samples.link_q16 > d->config.values.link_maximum) return FAULT_LINK_HIGH;
  if (polarity_watch_step(d)) return FAULT_POLARITY;
  return (drive_is_turning(d) && judges_now(d)) ? check_position(d, v, left) : FAULT_NONE;
}

// What an encoder makes of it that counts the other way round, as with two motor wires exchanged.
static bool is_of_angle(drive_fault_t fault) {
  return fault == FAULT_DIVERGENCE || fault == FAULT_SYNCHRONISM || fault == FAULT_POLARITY;
}

static bool is_reversed(const drive_t* d) { return d->source->is_reversed != NULL && d->source->is_reversed(d); }

drive_fault_t drive_protect(const drive_t* d, drive_supervision_t* v, deviation_residual_t* left) {
  if (!drive_is_energised()) return FAULT_NONE;
  const bool first_turns = polarity_watch_is_awake(d);
  const drive_fault_t fault = check(d, v, left);
  return (first_turns && is_of_angle(fault) && is_reversed(d)) ? FAULT_ENCODER : fault;
}

// Which angle and speed the control uses: those of the position source (interfaces/source.h).

#include "firmware/drive/position.h"

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

const int32_t position_per_windows_q30[ESTIMATOR_WINDOWS + 1] = {0, 1073741824L, 536870912L, 357913941L};

static bool is_slot(const drive_t* d, schedule_slot_t slot) { return d->schedule.slot == slot; }

// The estimator that looks at the windows first, as it was last.
static const estimator_output_t* first_of(const drive_t* d, uint16_t traits) {
  const drive_estimate_t* const p = &d->estimate;
  const bool low = ((traits & SOURCE_ALTERNATES) != 0u) ? position_low_alone(d) : (traits & SOURCE_AVV_FIRST) == 0u;
  return low ? &p->low : &p->high;
}

bool position_observer_rests(const drive_t* d) {
  return blend_is_high(&d->estimate.blend) && !polarity_watch_is_awake(d);
}

void position_bumpless_transfer(drive_estimate_t* e) {
  e->blend.region = BLEND_HIGH;
  e->blend.share_q15 = 0;
}

bool position_observer_reads(const drive_t* d) {
  return drive_source_has(d, SOURCE_READS) && !(drive_source_has(d, SOURCE_HANDS_OVER) && position_observer_rests(d));
}

// Angle in the middle of the windows' period, of a frame that has run on evenly since.
static uint32_t middle_of(const estimator_output_t* now) {
  return deviation_middle(now->angle_bam + (uint32_t)now->speed_bpp, now->speed_bpp);
}

// Mean of some currents less their ripple, of 4096 A at most, A.
static int32_t less_ripple_q20(int32_t sum_q18, int32_t ripple_q14, int32_t per_count_q30) {
  const int32_t ripple_q18 = q_within_bits(ripple_q14, 26) * 16;
  return q_within_bits(q_mul_hi(sum_q18 - ripple_q18, per_count_q30), DRIVE_CURRENT_BITS - 4u) * 16;
}

static void measure_current(const drive_t* d, drive_estimate_t* e, const estimator_output_t* first) {
  const drive_samples_t* const s = &d->samples;
  estimator_frame_t* const frames = e->frames;
  dq_t sum = {0, 0};
  const estimator_output_t* const selected = &e->selected;
  const uint32_t middle_bam = middle_of(first);
  deviation_frames(s->windows, s->count, middle_bam, machine_speed_rad_q30(first->speed_bpp), frames);
  for (uint16_t k = 0; k < s->count; k++) {
    sum.d += frames[k].current_q18.d;
    sum.q += frames[k].current_q18.q;
  }
  // The frame turns by 0.13 rad in a period at 3000 rpm on motor A: for a ripple one angle will do.
  const dq_t ripple_q16 = frame_park(s->ripple_q16, frames[s->count / 2u].rotation);
  const int32_t per_count_q30 = position_per_windows_q30[s->count];
  const dq_t mean_q20 = {less_ripple_q20(sum.d, q_mul_hi(e->model.yd_q30, ripple_q16.d), per_count_q30),
                         less_ripple_q20(sum.q, q_mul_hi(e->model.yq_q30, ripple_q16.q), per_count_q30)};
  e->measured_q20 = mean_q20;
  e->seen_q20 = mean_q20;
  if (first == selected || first->angle_bam == selected->angle_bam) return;
  const dq_t moved_q20 = frame_moved(mean_q20, middle_of(selected) - middle_bam);
  e->measured_q20.d = q_limit(moved_q20.d, DRIVE_CURRENT_END_Q20);
  e->measured_q20.q = q_limit(moved_q20.q, DRIVE_CURRENT_END_Q20);
}

void drive_estimate(const drive_t* d, drive_estimate_t* e) {
  const uint16_t count = (d->flags.invalid > 0u) ? 0u : d->samples.count;
  const bool measuring = d->state == DRIVE_COMMISSION && !d->flags.spins;
  const bool open_loop = d->flags.open_loop;
  const bool starting = !measuring && !d->schedule.turning;
  // Before the shaft turns the start's alone is at work. The spin of a commissioning does not run on the one selected,
  // which may want windows, or an alignment, of its own.
  const position_source_t* source = d->source;
  if (d->state == DRIVE_COMMISSION) source = edition_default_source;
  if (starting) source = edition_start_source;
  // The windows are turned into the frame of the estimator that looks at them first: the one in use, where it is alone,
  // or that looks on.
  const bool single = (source->traits & SOURCE_SINGLE) != 0u;
  const estimator_output_t* first = &e->selected;
  const estimator_frame_t* frames = e->frames;
  if (open_loop) {
    if (single) first = &e->seen;
    if (!single) frames = NULL;
  } else if (!(single || starting)) {
    first = first_of(d, source->traits);
  }
  if (count > 0u) measure_current(d, e, first);
  // With the gates off the windows are no answer to the pattern's voltages.
  if (starting && (d->flags.gates_off || !drive_is_energised())) return;
  const bool moves = (d->schedule.moves || is_slot(d, SLOT_OPERATING_POINT)) && !d->flags.frozen;
  if (moves) machine_model_follow(&e->model, e->measured_q20.q);
  const bool turns = is_slot(d, SLOT_LOOK) && !polarity_watch_is_awake(d) && !d->flags.frozen;
  if (turns) machine_model_renew_sensitivity(&e->model);
  estimator_input_t in;
  in.model = &e->model;
  in.regress = is_slot(d, SLOT_REGRESSION);
  in.renew = d->schedule.renews;
  in.refresh = moves || !d->schedule.turning;
  // Slower than this the angle is seen by the excitation alone, and less surely.
  const bool is_fast = moves && q_abs_sat(e->selected.speed_bpp) > d->config.blend.high_bpp;
  in.busy = is_fast || d->schedule.judges || d->schedule.task == TASK_SPEED || d->schedule.task == TASK_FIELD;
  in.windows = d->samples.windows;
  in.window_count = d->schedule.skips ? 0u : count;
  in.frames = frames;
  // While the polarity is open the sign of the torque is, too. A source that looks on is told what its own angle makes
  // of the current, as later.
  dq_t seen_q20 = e->measured_q20;
  if (open_loop) seen_q20 = (single && count > 0u) ? e->seen_q20 : position_seen(d, seen_q20);
  in.iq_q20 = open_loop ? seen_q20.q : e->seen_q20.q;
  in.torque_accel_q8 = starting ? 0 : q_mul_sat(machine_torque_q16(&e->model, seen_q20), e->model.accel_q12, 20);
  e->torque_accel_q8 = in.torque_accel_q8;
  inertia_match_add(&inertia_match, in.torque_accel_q8);
  if (open_loop || measuring) {
    e->selected = drive_states[d->state]->estimate(d, e, &in);
  } else {
    e->selected = source->step(d, e, &in);
  }
}

void position_preset_axis(drive_estimate_t* e, uint32_t angle_bam, int32_t seen_bpp) {
  const int32_t speed_bpp = q_limit(seen_bpp, MACHINE_SPEED_END_BPP);
  const estimator_output_t now = {angle_bam, speed_bpp, 0, 0};
  avv_preset(&e->avv, angle_bam, speed_bpp, 0);
  e->selected = now;
}

static void begin_source(const drive_t* d, bool keeps) {
  if (d->source->begin != NULL) d->source->begin(d, keeps);
}

void position_preset(const drive_t* d, drive_estimate_t* e, uint32_t angle_bam, int32_t seen_bpp) {
  position_preset_axis(e, angle_bam, seen_bpp);
  const int32_t speed_bpp = e->selected.speed_bpp;
  deviation_observer_preset(&e->observer, angle_bam, speed_bpp, 0);
  begin_source(d, false);
  blend_reset(&e->blend);
  if (drive_source_has(d, SOURCE_ALTERNATES)) blend_preset(&e->blend, &d->config.blend, speed_bpp);
  e->low = e->selected;
  e->high = e->selected;
}

void position_keep(const drive_t* d, drive_estimate_t* e) {
  e->selected = e->seen;
  begin_source(d, true);
}

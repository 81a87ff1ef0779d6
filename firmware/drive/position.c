// Which angle and speed the control uses: the position source, chosen by a table.

#include "firmware/drive/position.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/flux.h"
#include "hal/hal_encoder.h"

#define ONE_Q26 67108864L
#define ADAPT_ERROR_MAX_BAM 178956970L  // 15 degrees: beyond that the regression is not linear

static const int32_t per_windows_q30[ESTIMATOR_WINDOWS + 1] = {0, 1073741824L, 536870912L, 357913941L};

typedef estimator_output_t (*source_step_t)(drive_t* d, estimator_input_t* in);

static bool is_turn(const drive_t* d, turn_t turn) { return d->schedule.turn == turn; }

// A period with three windows has no room for both the polarity's watch and what else has the turn.
static bool is_full(const drive_t* d) { return d->samples.count >= ESTIMATOR_WINDOWS; }

static void match_sensors(drive_t* d, const regression_t* r, int32_t share_q30) {
  if (!d->modulation.state.is_alternating) return;
  sensor_match_step(&d->position.sensors, r, d->model.yd_q30 / 2 + d->model.yq_q30 / 2, share_q30);
  d->trim.mismatch_q30 = d->position.sensors.mismatch_q30;
}

// Resistance and flux are learnt once the drive runs; until then the sensors have that turn.
static void adapt(drive_t* d, const regression_t* r) {
  const bool likeness = is_turn(d, TURN_LIKENESS);
  if (!(likeness || is_turn(d, TURN_VOLTAGE)) || !d->position.is_near) return;
  // A turn takes 5/4 as long where it has eight of ten periods, and 5/2 where it has four; there, learning 3/2 as much
  // leaves the angle quieter.
  const int32_t share_q30 = d->config.adapt_share_q30 / 4 * (d->schedule.turning ? 6 : 5);
  const bool runs = drive_is_turning(d);
  if (likeness) admittance_step(&d->model, r, share_q30);
  if (likeness == runs) {
    match_sensors(d, r, share_q30);
  } else if (runs && !(polarity_watch_is_awake(d) && is_full(d))) {
    const int32_t w_q30 = machine_speed_rad_q30(d->position.used.speed_bpp);
    voltage_match_step(&d->model, r, w_q30, d->config.drift_share_q30 / 2 * 3);
  }
}

static void step_avv(drive_t* d, const estimator_input_t* in) {
  d->position.high = avv_step(&d->position.avv, &d->config.avv, in);
  if (d->state == DRIVE_COMMISSION && !d->commissioning.adapting) return;
  if (is_turn(d, TURN_REGRESS)) d->position.is_near = q_abs_sat(d->position.avv.error_bam) < ADAPT_ERROR_MAX_BAM;
  adapt(d, &d->position.avv.regression);
}

static estimator_output_t source_avv(drive_t* d, estimator_input_t* in) {
  step_avv(d, in);
  return d->position.high;
}

// Commissioning at standstill: AVV alone, or no measurement at all and the angle by the torque.
static estimator_output_t step_commissioning(drive_t* d, estimator_input_t* in) {
  if (!d->commissioning.predicting) return source_avv(d, in);
  tracking_observer_t* const o = &d->position.avv.observer;
  tracking_observer_predict(o, q_add_sat(in->torque_accel_q8, o->load_accel_q8));  // the load as of now is left out
  const estimator_output_t out = {o->angle_bam, o->speed_bpp, o->load_accel_q8, 32767};
  return out;
}

static estimator_output_t step_observer(drive_t* d, const estimator_input_t* in) {
  const deviation_observer_config_t* const c = hold_is_on(d) ? &d->config.hold_observer : &d->config.observer;
  d->position.low = deviation_observer_step(&d->position.observer, c, in);
  return d->position.low;
}

// One estimator for all speeds; the regression is that of its own deviations.
static estimator_output_t source_observer(drive_t* d, estimator_input_t* in) {
  const estimator_output_t out = step_observer(d, in);
  const regression_t* const r = &d->position.observer.regression;
  // Whether the windows agree with the angle, so that the regression is linear, is asked in the place behind it.
  if (is_turn(d, TURN_REGRESS)) d->position.is_near = in->regress && in->window_count > 0u;
  if (is_turn(d, TURN_LOOK)) d->position.is_near = d->position.is_near && avv_angle_is_near(r, &d->model);
  adapt(d, r);
  d->position.high = out;
  return out;
}

static estimator_output_t source_observer_avv(drive_t* d, estimator_input_t* in) {
  (void)step_observer(d, in);
  in->frames = 0;
  step_avv(d, in);
  return blend_step(&d->position.blend, &d->config.blend, &d->position.low, &d->position.high);
}

static estimator_output_t step_zvv(drive_t* d, const estimator_input_t* in) {
  const estimator_output_t out = zvv_step(&d->position.zvv, &d->config.zvv, in, d->control.reference_q20.d);
  d->position.deviation_q20 = d->position.zvv.deviation_q20;
  return out;
}

// Below the blend a period without active windows says nothing to AVV; above it nobody asks ZVV.
static bool zvv_alone(const drive_t* d) { return blend_is_low(&d->position.blend) && d->samples.count <= 1u; }
static bool avv_alone(const drive_t* d) { return blend_is_high(&d->position.blend); }

// Both at work, and no room for both in a period: ZVV looks at the windows beside speed control and field weakening,
// AVV in all others.
static void step_by_turns(drive_t* d, estimator_input_t* in) {
  drive_position_t* const p = &d->position;
  const uint16_t count = in->window_count;
  const bool is_long = d->schedule.task == TASK_SPEED || d->schedule.task == TASK_FIELD;
  const bool of_zvv = is_long != blend_is_low(&p->blend);
  if (of_zvv) in->window_count = 0;
  step_avv(d, in);
  if (of_zvv) {
    in->window_count = count;
    in->frames = 0;
    p->low = step_zvv(d, in);
  } else {
    zvv_wait(&p->zvv);
    p->low.angle_bam = p->zvv.angle_bam;
  }
}

// The estimator that is not asked stands by at the other's angle.
static estimator_output_t source_paper(drive_t* d, estimator_input_t* in) {
  drive_position_t* const p = &d->position;
  if (zvv_alone(d)) {
    p->low = step_zvv(d, in);
    p->high = p->low;
    avv_preset(&p->avv, p->low.angle_bam, p->low.speed_bpp, 0);
  } else if (avv_alone(d)) {
    step_avv(d, in);
    p->low = p->high;
    zvv_preset(&p->zvv, p->high.angle_bam, p->high.speed_bpp);
  } else {
    step_by_turns(d, in);
  }
  return blend_step(&p->blend, &d->config.blend, &p->low, &p->high);
}

// The reference encoder: angle from the count and the offset found at the start; a tracking observer makes a speed of
// it.
static uint32_t encoder_angle(const drive_t* d) {
  return position_encoder_angle(hal_encoder_count(), d->model.pole_pairs, parameters.encoder_counts);
}

static estimator_output_t source_encoder(drive_t* d, estimator_input_t* in) {
  in->frames = 0;
  const uint32_t angle = encoder_angle(d) + d->position.encoder_offset_bam;
  tracking_observer_predict(&d->position.encoder, in->torque_accel_q8);
  tracking_observer_correct(&d->position.encoder, angle_diff_bam(angle, d->position.encoder.angle_bam),
                            d->config.avv.bandwidth_long_q30);
  estimator_output_t out = {d->position.encoder.angle_bam, d->position.encoder.speed_bpp,
                            d->position.encoder.load_accel_q8, 32767};
  if (parameters.flux_beside > 0) {
    d->position.high = flux_source_look_on(d, in, &out);
  } else {
    step_avv(d, in);
  }
  d->position.low = out;
  // Behind the observer: turning the frame is no motion of the shaft.
  out.angle_bam += d->config.encoder_trim_bam;
  (void)zvv_deviation_q20(in, out.angle_bam, out.speed_bpp, &d->position.deviation_q20);
  return out;
}

// The observer below the blend, the stator flux above, both between. There nothing is learnt of the windows, for want
// of time.
static estimator_output_t source_flux(drive_t* d, estimator_input_t* in) {
  in->regress = in->regress && (d->position.blend.region == BLEND_LOW || polarity_watch_is_awake(d));
  if (flux_source_rests(d)) return flux_source_alone(d, in);
  const estimator_output_t low = source_observer(d, in);
  return flux_source_beside(d, in, &low);
}

static const source_step_t sources[] = {source_encoder, source_paper, source_observer_avv, source_avv, source_observer,
                                        source_flux,    source_flux,  source_flux,         source_flux};

// The estimator that looks at the windows first, as it was last.
static const estimator_output_t* first_of(const drive_t* d, int32_t source) {
  const drive_position_t* const p = &d->position;
  const bool low = (source == POSITION_PAPER) ? zvv_alone(d) : source != POSITION_AVV;
  return low ? &p->low : &p->high;
}

// Angle in the middle of the windows' period, of a frame that has run on evenly since.
static uint32_t middle_of(const estimator_output_t* now) {
  return deviation_middle(now->angle_bam + (uint32_t)now->speed_bpp, now->speed_bpp);
}

// Mean of some currents less their ripple, A.
static int32_t less_ripple_q20(int32_t sum_q20, int64_t ripple_q46, int32_t per_count_q30) {
  const int32_t left_q14 = (int32_t)q_shr64(q_product(sum_q20, ONE_Q26) - ripple_q46, 32);
  return q_sat_bits(q_product(left_q14, per_count_q30), 24, DRIVE_CURRENT_BITS);
}

static void measure_current(drive_t* d, const estimator_output_t* first) {
  drive_samples_t* const s = &d->samples;
  dq_t sum = {0, 0};
  const estimator_output_t* const used = &d->position.used;
  const uint32_t middle_bam = middle_of(first);
  deviation_frames(s->windows, s->count, middle_bam, machine_speed_rad_q30(first->speed_bpp), s->frames);
  for (uint16_t k = 0; k < s->count; k++) {
    sum.d += s->frames[k].current_q20.d;
    sum.q += s->frames[k].current_q20.q;
  }
  // The frame turns by 0.13 rad in a period at 3000 rpm on motor A: for a ripple one angle will do.
  const dq_t ripple_q16 = frame_park(s->ripple_q16, s->frames[s->count / 2u].rotation);
  const int32_t per_count_q30 = per_windows_q30[s->count];
  const dq_t mean_q20 = {less_ripple_q20(sum.d, q_product(d->model.yd_q30, ripple_q16.d), per_count_q30),
                         less_ripple_q20(sum.q, q_product(d->model.yq_q30, ripple_q16.q), per_count_q30)};
  d->control.measured_q20 = mean_q20;
  if (first == used || first->angle_bam == used->angle_bam) return;
  const dq_t moved_q20 = frame_moved(mean_q20, middle_of(used) - middle_bam);
  d->control.measured_q20.d = q_limit(moved_q20.d, DRIVE_CURRENT_END_Q20);
  d->control.measured_q20.q = q_limit(moved_q20.q, DRIVE_CURRENT_END_Q20);
}

// The I-F start: the control uses the vector's frame, and the source looks on. At rest the angle is the vector's: a
// saliency has two.
static void estimate_turned(drive_t* d, estimator_input_t* in) {
  drive_start_t* const s = &d->start;
  if (flux_source_rests(d) && !if_start_is_up(&s->turn, &d->config.turn)) {
    flux_source_follow(d, &d->position.used);
    s->seen = d->position.used;
  } else if (s->turn.tick < d->config.turn.align_periods) {
    position_preset(d, d->position.used.angle_bam, d->position.used.speed_bpp);
    s->seen = d->position.used;
  } else {
    s->seen = sources[parameters.position_source](d, in);
  }
  d->position.used.angle_bam = s->turn.angle_bam + (uint32_t)s->turn.speed_bpp;
  d->position.used.speed_bpp = s->turn.speed_bpp;
}

void drive_estimate(drive_t* d) {
  const uint16_t count = drive_is_blind(d) ? 0u : d->samples.count;
  const bool measuring = d->state == DRIVE_COMMISSION && !d->commissioning.turning;
  const bool turned = drive_is_turned(d);
  const bool starting = !measuring && !d->schedule.turning;
  // The spin of a commissioning runs on the observer: the other sources want windows, or an alignment, of their own.
  const int32_t source = (d->state == DRIVE_COMMISSION) ? POSITION_OBSERVER : parameters.position_source;
  // The windows are turned into the frame of the estimator that looks at them first: the one in use, where it is alone.
  const bool alone = source == POSITION_OBSERVER || source == POSITION_ENCODER || starting || turned;
  const estimator_output_t* const first = alone ? &d->position.used : first_of(d, source);
  if (count > 0u) measure_current(d, first);
  const bool moves = d->schedule.moves || is_turn(d, TURN_MOVE);
  if (moves) machine_model_follow(&d->model, d->control.measured_q20.q);
  if (is_turn(d, TURN_LOOK) && !polarity_watch_is_awake(d)) machine_model_turn(&d->model);
  estimator_input_t in;
  in.model = &d->model;
  in.regress = is_turn(d, TURN_REGRESS);
  in.renew = d->schedule.renews;
  in.refresh = moves || !d->schedule.turning;
  in.windows = d->samples.windows;
  in.window_count = d->schedule.skips ? 0u : count;
  in.frames = (turned || measuring) ? 0 : d->samples.frames;
  // While the polarity is open the sign of the torque is, too. A source that looks on is told what its own angle makes
  // of the current, as later.
  const dq_t seen_q20 = turned ? drive_seen(d, d->control.measured_q20) : d->control.measured_q20;
  in.torque_accel_q8 = starting ? 0 : q_mul_sat(machine_torque_q16(&d->model, seen_q20), d->model.accel_q12, 20);
  d->position.torque_accel_q8 = in.torque_accel_q8;
  inertia_match_add(&d->inertia, in.torque_accel_q8);
  if (turned) {
    estimate_turned(d, &in);
  } else if (measuring) {
    d->position.used = step_commissioning(d, &in);
  } else {
    d->position.used = starting ? source_avv(d, &in) : sources[source](d, &in);
  }
}

void position_preset_axis(drive_t* d, uint32_t angle_bam, int32_t seen_bpp) {
  drive_position_t* const p = &d->position;
  const int32_t speed_bpp = q_limit(seen_bpp, MACHINE_SPEED_END_BPP);
  const estimator_output_t now = {angle_bam, speed_bpp, 0, 0};
  avv_preset(&p->avv, angle_bam, speed_bpp, 0);
  p->used = now;
}

void position_preset(drive_t* d, uint32_t angle_bam, int32_t seen_bpp) {
  drive_position_t* const p = &d->position;
  position_preset_axis(d, angle_bam, seen_bpp);
  const int32_t speed_bpp = p->used.speed_bpp;
  deviation_observer_preset(&p->observer, angle_bam, speed_bpp, 0);
  zvv_preset(&p->zvv, angle_bam, speed_bpp);
  flux_observer_reset(&p->flux, &d->config.flux, &d->model);
  blend_reset(&p->blend);
  if (parameters.position_source == POSITION_PAPER) blend_preset(&p->blend, &d->config.blend, speed_bpp);
  p->low = p->used;
  p->high = p->used;
}

void position_align_encoder(drive_t* d, uint32_t angle_bam, int32_t speed_bpp) {
  d->position.encoder_offset_bam = angle_bam - encoder_angle(d);
  d->position.aligned_bam = angle_bam;
  tracking_observer_preset(&d->position.encoder, angle_bam, q_limit(speed_bpp, MACHINE_SPEED_END_BPP), 0);
}

bool position_encoder_is_reversed(const drive_t* d) {
  if (parameters.position_source != POSITION_ENCODER) return false;
  const uint32_t encoder_bam = d->position.encoder.angle_bam - d->position.aligned_bam;
  const uint32_t windows_bam = d->position.high.angle_bam - d->position.aligned_bam;
  return q_abs_sat(angle_diff_bam(windows_bam + encoder_bam, 0)) <
         q_abs_sat(angle_diff_bam(windows_bam, encoder_bam)) / 2;
}

uint32_t position_encoder_angle(uint32_t count, int32_t pole_pairs, int32_t counts_per_turn) {
  // 2^32 / counts, exact where the counts are a power of two, to 1e-5 of a turn otherwise.
  const uint32_t per_count = 0xFFFFFFFFuL / (uint32_t)counts_per_turn + 1u;
  return count * per_count * (uint32_t)pole_pairs;
}

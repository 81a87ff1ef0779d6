// The paper's scheme: ZVV and AVV, blended.

#include "firmware/sources/paper/paper.h"

#include <stddef.h>

#include "firmware/base/clear.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/position.h"
#include "firmware/sources/observer/observer.h"
#include "hal/qmath/qcall.h"

#define PER_PERIOD2_Q18 11258999L  // rad/s^2 (Q8) to rad per period^2 (Q40)
#define AMPERE_Q20 1048576L
#define NO_TRAJECTORY_MS_Q8 256L   // one step: the target is the command
#define ZVV_PERIODS_OF_MS 0x02A5u  // whose windows it has then: 0, 2, 5, 7, 9

// Of paper_terms, beside those of zvv.h.
#define LONG_ZERO_BY_TURNS 16u
#define TRAJECTORY 32u     // not the command itself as the target (53)
#define AVV_RESIDUALS 64u  // not the slopes' differences and an arc tangent (37) to (41)

zvv_t paper_zvv;
zvv_config_t paper_config;

static zvv_config_t made;

void paper_reset(void) {
  clear(&paper_zvv, sizeof paper_zvv);
  source_deviation_q20 = 0;
}

static packed_text_t make(drive_config_t* c) {
  const parameters_t* const p = &parameters;
  made.kp_q30 = qc_mul(p->zvv_proportional, CONFIG_PER_PERIOD_Q20, 20);
  made.ki_q40 = qc_mul(p->zvv_integral, PER_PERIOD2_Q18, 18);
  made.terms = (uint16_t)p->paper_terms;
  if (!drive_source_selected_has(SOURCE_ALTERNATES)) return PACKED_NONE;
  if ((made.terms & TRAJECTORY) == 0u) c->speed.trajectory_ms_q8 = NO_TRAJECTORY_MS_Q8;
  const bool lacks_current = qc_abs_sat(p->id_low_speed) < AMPERE_Q20;
  return lacks_current ? SAY_position_source_1_needs_id_low_speed : PACKED_NONE;
}

static void take(void) { paper_config = made; }

const config_part_t paper_part = {make, take};

// Below this speed there are long zero vectors alone.
static int32_t enter_bpp(const drive_t* d) { return d->config.blend.low_bpp / 4 * 3; }

// Both at work, in periods of their own: long zero vectors and extended active ones by turns, where the pulses are left
// to the source.
static bool is_by_turns(const drive_t* d) {
  return (paper_config.terms & LONG_ZERO_BY_TURNS) != 0u && !blend_is_high(&d->estimate.blend) &&
         d->config.values.excitation == EXCITATION_BY_SOURCE &&
         q_abs_sat(d->estimate.selected.speed_bpp) >= enter_bpp(d);
}

static void step_zvv(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in) {
  e->low = zvv_step(&paper_zvv, &paper_config, in, d->control.references.current_q20.d);
  source_deviation_q20 = paper_zvv.deviation_q20;
}

static void step_avv(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in) {
  if ((paper_config.terms & AVV_RESIDUALS) != 0u) {
    source_step_avv(d, e, in);
  } else {
    e->high = avv_printed_step(&e->avv, &d->config.avv, in);
  }
}

// Above the blend nobody asks ZVV.
static bool avv_alone(const drive_t* d) { return blend_is_high(&d->estimate.blend); }

// Who looks at the windows where there is no room for both in a period: by turns the one that they were made for, else
// ZVV beside speed control and field weakening and AVV in all others.
static bool is_of_zvv(const drive_t* d) {
  if (is_by_turns(d)) return d->samples.count <= 1u;
  const bool is_long = d->schedule.task == TASK_SPEED || d->schedule.task == TASK_FIELD;
  return is_long != blend_is_low(&d->estimate.blend);
}

static void step_alternately(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  const uint16_t count = in->window_count;
  const bool of_zvv = is_of_zvv(d);
  if (of_zvv) in->window_count = 0;
  step_avv(d, e, in);
  if (of_zvv) {
    in->window_count = count;
    in->frames = 0;
    step_zvv(d, e, in);
  } else {
    zvv_wait(&paper_zvv);
    e->low.angle_bam = paper_zvv.angle_bam;
  }
}

// The estimator that is not asked stands by at the other's angle.
static estimator_output_t source_paper(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  if (position_low_alone(d) && !is_by_turns(d)) {
    step_zvv(d, e, in);
    e->high = e->low;
    avv_preset(&e->avv, e->low.angle_bam, e->low.speed_bpp, e->low.load_accel_q8);
  } else if (avv_alone(d)) {
    step_avv(d, e, in);
    e->low = e->high;
    zvv_preset(&paper_zvv, e->high.angle_bam, e->high.speed_bpp, e->high.load_accel_q8);
  } else {
    step_alternately(d, e, in);
  }
  return blend_step(&e->blend, &d->config.blend, &e->low, &e->high);
}

// Long zero vectors at low speed and extended active ones from below the blend on.
static excitation_t paper_excitation(const drive_t* d) {
  if (is_by_turns(d)) {
    // What is made in this period acts in the next and is looked at in the one after that.
    const unsigned seen = (d->schedule.period + 2u) % DRIVE_PERIODS_PER_MS;
    return ((ZVV_PERIODS_OF_MS >> seen & 1u) != 0u) ? EXCITATION_LONG_ZERO : EXCITATION_EXTENDED;
  }
  return (q_abs_sat(d->estimate.selected.speed_bpp) < enter_bpp(d)) ? EXCITATION_LONG_ZERO : EXCITATION_EXTENDED;
}

static void paper_begin(const drive_t* d, bool keeps) {
  if (!keeps) zvv_preset(&paper_zvv, d->estimate.selected.angle_bam, d->estimate.selected.speed_bpp, 0);
}

const position_source_t paper_source = {
    source_paper, paper_excitation, NULL, NULL, paper_begin, NULL, SOURCE_BLENDS | SOURCE_ALTERNATES, 3};

// The paper's scheme: ZVV and AVV, blended.

#include "firmware/sources/paper/paper.h"

#include <stddef.h>

#include "firmware/base/clear.h"
#include "firmware/drive/position.h"
#include "firmware/sources/sources.h"

zvv_t paper_zvv;

void paper_reset(void) { clear(&paper_zvv, sizeof paper_zvv); }

static estimator_output_t step_zvv(drive_t* d, const estimator_input_t* in) {
  const estimator_output_t out = zvv_step(&paper_zvv, &d->config.zvv, in, d->control.reference_q20.d);
  d->position.deviation_q20 = paper_zvv.deviation_q20;
  return out;
}

// Above the blend nobody asks ZVV.
static bool avv_alone(const drive_t* d) { return blend_is_high(&d->position.blend); }

// Both at work, and no room for both in a period: ZVV looks at the windows beside speed control and field weakening,
// AVV in all others.
static void step_alternately(drive_t* d, estimator_input_t* in) {
  drive_position_t* const p = &d->position;
  const uint16_t count = in->window_count;
  const bool is_long = d->schedule.task == TASK_SPEED || d->schedule.task == TASK_FIELD;
  const bool of_zvv = is_long != blend_is_low(&p->blend);
  if (of_zvv) in->window_count = 0;
  source_step_avv(d, in);
  if (of_zvv) {
    in->window_count = count;
    in->frames = 0;
    p->low = step_zvv(d, in);
  } else {
    zvv_wait(&paper_zvv);
    p->low.angle_bam = paper_zvv.angle_bam;
  }
}

// The estimator that is not asked stands by at the other's angle.
static estimator_output_t source_paper(drive_t* d, estimator_input_t* in) {
  drive_position_t* const p = &d->position;
  if (position_low_alone(d)) {
    p->low = step_zvv(d, in);
    p->high = p->low;
    avv_preset(&p->avv, p->low.angle_bam, p->low.speed_bpp, 0);
  } else if (avv_alone(d)) {
    source_step_avv(d, in);
    p->low = p->high;
    zvv_preset(&paper_zvv, p->high.angle_bam, p->high.speed_bpp);
  } else {
    step_alternately(d, in);
  }
  return blend_step(&p->blend, &d->config.blend, &p->low, &p->high);
}

// Long zero vectors at low speed and extended active ones from below the blend on.
static excitation_t paper_excitation(const drive_t* d) {
  const int32_t enter = d->config.blend.low_bpp / 4 * 3;
  return (q_abs_sat(d->position.selected.speed_bpp) < enter) ? EXCITATION_LONG_ZERO : EXCITATION_EXTENDED;
}

static void paper_begin(drive_t* d, bool keeps) {
  if (!keeps) zvv_preset(&paper_zvv, d->position.selected.angle_bam, d->position.selected.speed_bpp);
}

const position_source_t paper_source = {source_paper, paper_excitation, NULL,
                                        NULL,         paper_begin,      SOURCE_BLENDS | SOURCE_ALTERNATES};

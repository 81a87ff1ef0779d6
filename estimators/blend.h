// Hand-over between the low-speed and the high-speed estimator (seed paper, section 6, eqs (42)-(44)).
//
// The share of the low-speed estimator falls linearly from 1 to 0 between two *mechanical* speeds (magnitudes). Angles
// are mixed along the shortest arc; a plain weighted sum, as (42) is printed, fails at +-pi. A small state machine with
// hysteresis decides when the region is entered and left, and the share moves at a bounded rate, so that no step of
// either estimate becomes a step of the result.

#ifndef STILLSPIN_ESTIMATORS_BLEND_H
#define STILLSPIN_ESTIMATORS_BLEND_H

#include "estimators/estimator.h"

typedef enum { BLEND_LOW = 0, BLEND_BOTH = 1, BLEND_HIGH = 2 } blend_region_t;

typedef struct {
  int32_t low_bpp, high_bpp;  // electrical speeds of the region's ends, low < high
  int32_t hysteresis_bpp;     // less than (high - low) / 2
  int32_t rate_q15;           // largest change of the share per period
  int32_t per_range_q30;      // set by blend_design
} blend_config_t;

typedef struct {
  blend_region_t region;
  int32_t share_q15;         // of the low-speed estimator
  int32_t disagreement_bam;  // low-speed minus high-speed angle
} blend_t;

/// Returns false when low >= high.
bool blend_design(blend_config_t* c, int32_t low_bpp, int32_t high_bpp);

void blend_reset(blend_t* s);

/// Where the speed is known.
void blend_preset(blend_t* s, const blend_config_t* c, int32_t speed_bpp);

/// True where the result is the low-speed, or the high-speed, estimator's alone and will be in this step.
bool blend_is_low(const blend_t* s);
bool blend_is_high(const blend_t* s);

estimator_output_t blend_step(blend_t* s, const blend_config_t* c, const estimator_output_t* low,
                              const estimator_output_t* high);

#endif

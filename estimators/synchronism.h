// Loss of synchronism: does the angle in use still fit the machine?
//
// Whatever estimator an angle comes from, the windows must obey the voltage equation in the frame of that angle. The
// residual of the mean window of a period (deviation.h), times the L/T of the operating point, is an EMF error in
// volts, expected less true:
//   e = w lambda (-sin d, 1 - cos d) + saliency terms     for a frame that is ahead by d and turns with the shaft,
// |e| = w lambda at d = 60 degrees, 1.4 w lambda at 90 and 2 w lambda with the polarity reversed; an angle that stands
// or slips gives the EMF of one of the two speeds. It is compared with floor + share |w^ lambda|. The floor stands for
// what is wrong at any speed (drops, resistance, and the converter: it grows where the windows are shorter than half a
// period together), the share for wrong flux and link voltage. A speed that a load changes is known late: while it
// follows, what it changes in 4 ms is borne as well. Saliency cannot say this: it repeats every half turn.
//
// Expected is the EMF of the speed in use, and in a second error that of the frame's own speed. An observer whose
// polarity is reversed takes the EMF for a speed and leaves little of it over; but the saliency goes the other way, so
// it corrects its angle all the time, and its frame turns with the shaft.
//
// Doubt grows the faster the larger the error is, with its square. But what a healthy drive has beyond the limit is
// short, however large: a current that steps on a saturated machine. Hence the mean, in which what is beyond one and a
// half limits counts as these: a loss gets there and stays.
//
// Beside it counts the disagreement of two estimators beyond a quarter turn: one of them is then lost.
//
// Not seen: a reversed polarity without speed. It shows as soon as current moves the shaft the wrong way, from
// w lambda = floor / (2 - share) on.

#ifndef STILLSPIN_ESTIMATORS_SYNCHRONISM_H
#define STILLSPIN_ESTIMATORS_SYNCHRONISM_H

#include "estimators/estimator.h"

typedef struct {
  int32_t floor_q16;    // V; with 0 nothing is seen at rest
  int32_t share_q15;    // of the EMF that the speed lets expect, 0..1
  int32_t bad_periods;  // this many periods at the limit are a loss, of larger errors fewer; eight good ones make up
                        // for one; up to 10000
} synchronism_config_t;

typedef struct {
  dq_t error_q16;      // EMF error, first-order mean over 4 periods, or a millisecond where several come at once, V
  int32_t turned_q16;  // the same along q with the EMF of the frame's own speed, V
  int32_t emf_q16;     // EMF that the speed has let expect, the same mean, V
  int32_t limit_q16;   // what the error may be now, V, up to 500
  int32_t debounce;    // eight for a period at the limit, less one for a good one
} synchronism_t;

void synchronism_reset(synchronism_t* s);

/// What the windows leave unexplained.
typedef struct {
  dq_t residual_q20;   // mean by spans, A per period
  int32_t span_ticks;  // of all windows of a period, 0 where there are none
  int32_t speed_bpp;   // in use
  int32_t ahead_bpp;   // how much faster the frame has turned since the last time
  int32_t periods;     // since the last time, 1..63
} synchronism_seen_t;

/// Residual and span of one period's windows, at an angle at the end of that period and at the speed in use.
void synchronism_look(synchronism_seen_t* seen, const machine_model_t* m, const estimator_window_t windows[],
                      uint16_t count, uint32_t angle_bam);

/// Takes what an estimator or synchronism_look has seen; it may be done every few periods. apart_bam is how far two
/// estimators are apart, 0 where there is one. Returns true when synchronism is lost. A period without windows changes
/// nothing.
bool synchronism_judge(synchronism_t* s, const synchronism_config_t* c, const machine_model_t* m,
                       const synchronism_seen_t* seen, int32_t apart_bam);

#endif

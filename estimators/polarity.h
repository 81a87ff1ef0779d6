// Polarity of the magnet by motion: which of the two half turns left open by the saliency is the right one.
//
// Saturation cannot tell it on a machine with linear magnetics, so the shaft is asked: the current pattern + - (pause)
// - + along the estimated q-axis moves it by a fraction of a mechanical degree and brings it back to rest; with the
// wrong polarity it moves the other way. The pattern is then repeated with opposite sign and the two responses are
// subtracted, which removes what a constant load does. The response is the mean angle in the pause, where the excursion
// is largest, less that before and after the pattern. All three are taken without current: cross-saturation turns the
// axis that the windows see by as much as the shaft moves.
//
// A segment lasts 20 to 160 periods, for the shaft to turn by some degrees in it: 40 on a machine whose current and
// inertia go together as usual, the whole test then 560 (56 ms at 10 kHz). A response below a quarter of what the
// inertia lets expect is ambiguous (blocked shaft, far too large inertia, noise), and so is one below four times its
// standard error, which the scatter of the angle tells. A shaft that turns already, too slowly for its EMF to be seen,
// is asked in a frame that turns with it: what is left of its speed goes out of the response. A shaft may be any number
// of times lighter than nominal; but where the test is not the first, because the voltage was too low for the one
// before, a response above eight times the expectation is what that one has left moving (bounded).

#ifndef STILLSPIN_ESTIMATORS_POLARITY_H
#define STILLSPIN_ESTIMATORS_POLARITY_H

#include "estimators/estimator.h"

#define POLARITY_SEGMENT 40  // periods, usually
#define POLARITY_SEGMENTS 7  // of one pattern

typedef enum { POLARITY_PENDING = 0, POLARITY_RIGHT = 1, POLARITY_WRONG = 2, POLARITY_AMBIGUOUS = 3 } polarity_result_t;

typedef struct {
  int16_t length;        // of a segment, periods
  int16_t tick;          // periods since its start
  int16_t segment;       // of the present pattern
  int16_t passes;        // of both patterns, counted together
  int32_t current_q20;   // amplitude, A; below zero in the second pattern
  int32_t expected_bam;  // response if the model is right
  int32_t response_bam;  // sum so far
  int32_t rough_bam;     // sum of the differences between neighbouring angles in the pauses, 2^-8
  uint32_t last_bam;     // the angle before
  int32_t sigma_q8;      // response over its standard error
  uint32_t origin_bam;   // angle at the beginning, turned on with the shaft's speed
  int32_t speed_bpp;     // of the shaft at the beginning
  bool bounded;          // a response far beyond the expected one says nothing
  polarity_result_t result;
} polarity_t;

/// amplitude in A; accel_q8: electrical acceleration that it makes. The first one, on memory that is all zero, chooses
/// the segment's length for the shaft to turn by 1.5 to 10 degrees in it; those after it keep it. Not bounded.
void polarity_begin(polarity_t* s, int32_t current_q20, int32_t accel_q8, uint32_t angle_bam, int32_t speed_bpp);

/// Repeats the test with the same current and adds to what it has shown; at most 6 passes.
void polarity_again(polarity_t* s, uint32_t angle_bam, int32_t speed_bpp);

/// One period: takes the measured angle (unfiltered), returns the q-axis current to command, A Q20.
int32_t polarity_step(polarity_t* s, uint32_t angle_bam);

#endif

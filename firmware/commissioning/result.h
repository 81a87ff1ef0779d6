// Which of the values that a commissioning found are believed, and why the others are not.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_RESULT_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_RESULT_H

#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/solve.h"

#define COMMISSIONING_RESULTS 24u

typedef struct {
  uint16_t count;
  commissioning_result_t list[COMMISSIONING_RESULTS];
} commissioning_report_t;

/// Evaluates the sums and says of each value whether it is believed.
void commissioning_judge(const commissioning_t* c, commissioning_report_t* report);

/// Writes what is believed into the parameters (gates off, background level) and says what became of each. By itself,
/// because both need much of the stack.
commissioning_outcome_t commissioning_use(commissioning_report_t* r);

/// Whether the map's level that is complete has lost the saliency. Sets how fast the current of the next one may
/// change.
bool commissioning_judge_level(commissioning_t* c);

/// After the spin: what the torque trains of the map need for the shaft's motion. Keeps the model's own values where
/// the spin's are not plausible.
void commissioning_solve_motion(commissioning_t* c);

#endif

// Which of the values that a commissioning found are believed, and why the others are not.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_RESULT_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_RESULT_H

#include "firmware/commissioning/solve.h"

#define COMMISSIONING_RESULTS 24u

typedef struct {
  commissioning_result_t list[COMMISSIONING_RESULTS];
  uint16_t count;
} commissioning_report_t;

/// Evaluates the sums, writes the plausible values into the parameters (gates off, background level) and says what
/// became of each.
commissioning_outcome_t commissioning_conclude(const commissioning_t* c, commissioning_report_t* report);

/// After the spin: what the torque trains of the map need for the shaft's motion. Keeps the model's own values where
/// the spin's are not plausible.
void commissioning_solve_motion(commissioning_t* c);

#endif

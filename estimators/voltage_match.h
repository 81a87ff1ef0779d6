// Slow adaptation of the stator resistance and of the magnet flux to what the windows show.
//
// The mean residual of a period (regression.h), seen as a voltage of the q axis, is what resistance and back-EMF leave
// unexplained: e_q = r_q / yq = -dR i_q - w dpsi, i_q being the model's operating point. One equation a period for two
// unknowns; a normalised least-mean-squares step moves each by what it can have caused, so that R (and with it what the
// devices' drops differ) is learnt under load at low speed, and the flux at speed. Both stay within bounds around the
// parameters. Far slower than the estimators, which therefore see constants.

#ifndef STILLSPIN_ESTIMATORS_VOLTAGE_MATCH_H
#define STILLSPIN_ESTIMATORS_VOLTAGE_MATCH_H

#include "estimators/regression.h"

/// Adds to what the model's trim has of the resistance.
void voltage_match_resistance(machine_model_t* m, int32_t more_q24);

/// Moves the model's trim; share_q30: part of the error taken over per period, 0 for none.
void voltage_match_step(machine_model_t* m, const regression_t* r, int32_t w_q30, int32_t share_q30);

#endif

// Maximum torque per ampere: the d-axis current that goes with a torque current so that the vector is the shortest that
// makes the torque. Source: Morimoto et al., IEEE Trans. Ind. Appl. 30 (1994), as seed paper B takes it ([24]).
//
// With a = lambda / (2 (Lq - Ld)) the condition is i_d^2 - 2 a i_d - i_q^2 = 0. Its root i_d = a - sqrt(a^2 + i_q^2) is
// a difference of nearly equal numbers; written as
//   i_d = -i_q^2 / (a + sqrt(a^2 + i_q^2))
// it is exact for every saliency, and goes to zero where there is none. Currents A Q20.

#ifndef STILLSPIN_CONTROL_MTPA_H
#define STILLSPIN_CONTROL_MTPA_H

#include "control/machine_model.h"

typedef struct {
  int32_t pole_q20;  // a, A; 0: the saliency is too small, i_d is zero
} mtpa_t;

/// Derives a. Beyond 1000 A there is no saliency worth it: the i_d left out is less than i_q^2 / 2000 A.
void mtpa_design(mtpa_t* s, const machine_model_t* m);

/// i_d for a torque current of either sign, up to 200 A; never positive.
int32_t mtpa_current_q20(const mtpa_t* s, int32_t iq_q20);

#endif

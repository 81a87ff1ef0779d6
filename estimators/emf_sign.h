// Polarity of the magnet from the back-EMF, once the shaft turns: a check, not an estimator.
//
// In the rotor frame v_q - R i_q - L_q di_q/dt - w L_d i_d = w lambda. With a speed that follows the saliency, and so
// is right whichever way round the magnet is, a wrong polarity lets the left-hand side come out with the wrong sign.
// Both sides are filtered over four looks; the answer counts above an EMF of 10 V (130 rpm on motor A), where
// drops, dead time and resistance cannot turn the sign, and after 5 ms.

#ifndef STILLSPIN_ESTIMATORS_EMF_SIGN_H
#define STILLSPIN_ESTIMATORS_EMF_SIGN_H

#include "control/machine_model.h"

typedef enum { EMF_SIGN_OPEN = 0, EMF_SIGN_RIGHT = 1, EMF_SIGN_REVERSED = 2 } emf_sign_result_t;

typedef struct {
  int32_t seen_q16;      // filtered EMF in the direction of rotation, V
  int32_t expected_q16;  // filtered |w| lambda, V
  int32_t last_iq_q20;   // A
  int32_t emf_q16;       // as last looked at, V
  int16_t periods;       // that it stands for until it is judged, 0 from then on
  int16_t agreed;        // periods in which the sign has been right, or less than 0: wrong
} emf_sign_t;

void emf_sign_reset(emf_sign_t* s);

typedef struct {
  int32_t voltage_q_q16;  // mean command along q since the last time, V
  dq_t current_q20;       // measured, A
  int32_t speed_bpp;      // by the saliency
  int32_t periods;        // since the last time, 1 or more
} emf_sign_seen_t;

/// A look in the rotor frame, once in one or several periods.
void emf_sign_look(emf_sign_t* s, const machine_model_t* m, const emf_sign_seen_t* seen);

/// What the last look says, at the speed by the saliency; nothing more without one since the last time.
emf_sign_result_t emf_sign_judge(emf_sign_t* s, const machine_model_t* m, int32_t speed_bpp);

#endif

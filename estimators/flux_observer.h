// Position from the stator flux: the family of Ton, Hsieh and Chen (IEEE Access 2021) as one estimator.
//
//   CONV    f-t-axis currents, (13)-(15)
//   PP-01   estimated d-q currents, (27), (29)-(31), of the flux seen
//   PP-02   the same of the reference flux (33), the flux by the bare low-pass with (34), (35)
//   ACTIVE  active flux, (11), (12)
//
// Fig. 5 gives the flux of all but PP-02. (32), speed by a derivative and a low-pass, is a tracking observer here, as
// behind AVV: it gives the load as well, and the drive's own acceleration does not make it lag.
//
// The cut-off is half the speed, but cutoff_q30 at least, and at most 0.033 with Fig. 5 and 0.015 without. An offset of
// the flux turns the angle to and fro once a turn, the speed control answers with a current that stands still in the
// stationary frame, and dead time and resistance make a voltage of it that feeds the offset: it has to decay faster,
// which it does with 3/16 w by Fig. 5 and with w/2 by the bare low-pass.
//
// The speed in (34) closes a loop: a speed that is too small corrects too much, which turns the angle back. From angle
// to angle it is w_c s / ((s + w_c)^2 + w^2), at most 1/2 at any speed, and the tracking observer's own at most 1.2.
//
// Needs the mean voltage of every period. A phase without current makes its voltage itself, within what dead time and
// drops leave open: below unknown_voltage_q20, and below the speed at which the magnet is learnt, the EMF along it is
// not the nominal one, but what the flux makes at the observed speed. Where the cut-off is the least one (quality_q15
// is 0 there), the integral is not to be trusted.
//
// As printed (is_printed) PP-02 takes its flux where the others do and turns the angle by (34) below the cut-off: by
// 45 degrees at once, and what Fig. 5 has mended is mended twice. To show it.

#ifndef STILLSPIN_ESTIMATORS_FLUX_OBSERVER_H
#define STILLSPIN_ESTIMATORS_FLUX_OBSERVER_H

#include "estimators/estimator.h"
#include "estimators/flux_adaptation.h"
#include "estimators/stator_flux.h"
#include "estimators/tracking_observer.h"

typedef enum { FLUX_CONV = 0, FLUX_PP01 = 1, FLUX_PP02 = 2, FLUX_ACTIVE = 3 } flux_method_t;

typedef struct {
  flux_method_t method;
  bool is_plain;                // all but PP-02 on the low-pass as it is, at cutoff_q30, as the paper explains them
  bool is_printed;              // at cutoff_q30 always, PP-02 on the same flux as the others, with (34) below it
  int32_t cutoff_q30;           // w_c T of the low-pass integrator, the least where it moves, 1e-4..0.015
  int32_t bandwidth_q30;        // bandwidth * T of the tracking observer, 1e-4..0.1
  int32_t unknown_voltage_q20;  // current of a phase below which its voltage is not known, A; 0 for none
  flux_adaptation_config_t adaptation;
  uint16_t adaptation_periods;  // between two steps of it, 1..1000; in the mean, where more than 32
} flux_observer_config_t;

/// The period that has just ended.
typedef struct {
  ab_t voltage_q16;    // mean at the terminals: switching states and DC link, less the devices' drops, V
  ab_t current_q20;    // at its end, without ripple, A
  dq_t measured_q20;   // the same in the frame in use
  dq_t reference_q20;  // the current references that were in force
  bool is_full;        // no time for the adaptation, which waits
} flux_period_t;

typedef struct {
  flux_machine_t machine;
  stator_flux_config_t form;
  stator_flux_t flux;
  flux_adaptation_t adaptation;
  tracking_observer_t observer;
  ab_t flux_q16;           // of the last step, V period
  flux_vectors_t vectors;  // of the last step
  ab_t current_q20;        // at the end of the last period, A
  int32_t error_bam;       // last angle seen, less the observed one
  int32_t load_angle_bam;  // of the last step
  uint16_t pause;          // periods until the adaptation's next step
  uint16_t place;          // of the last one, periods behind an even interval
} flux_observer_t;

/// False where a value or the machine is out of range.
bool flux_observer_config_valid(const flux_observer_config_t* c, const machine_model_t* m);

/// Forgets what was learnt of the machine.
void flux_observer_reset(flux_observer_t* s, const flux_observer_config_t* c, const machine_model_t* m);

/// Starts with an angle, speed, load and current (at that angle, A) that are known: the flux is (3).
void flux_observer_preset(flux_observer_t* s, const estimator_output_t* now, dq_t current_q20);

/// Forgets little for some 100 ms: the current changes at once, and the flux's length with it.
void flux_observer_keep(flux_observer_t* s);

/// One period. Of `in` it takes the model's resistance and nameplate and the torque's acceleration, no windows.
estimator_output_t flux_observer_step(flux_observer_t* s, const flux_observer_config_t* c, const estimator_input_t* in,
                                      const flux_period_t* period);

#endif

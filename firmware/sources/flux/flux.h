// The stator flux as a position source: joins estimators/flux_observer.h with the drive.
//
// Below flux_low the deviation observer has the shaft and the flux is set to what its angle lets expect; between
// flux_low and flux_high both run, and blend.h hands over; above, the flux runs alone and the observer is carried
// along with it. Above, the pulses are centred: the flux needs no measuring windows beyond one for the current.

#ifndef STILLSPIN_FIRMWARE_SOURCES_FLUX_H
#define STILLSPIN_FIRMWARE_SOURCES_FLUX_H

#include "estimators/flux_observer.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/mode/mode.h"

extern flux_observer_t flux_observer;

/// What flows against the d-axis so that the flux is observable, A.
extern int32_t flux_observability_q20;

/// As after power-on.
void flux_reset(void);

/// Its constants in use.
extern flux_observer_config_t flux_config;

/// Makes them; false where the flux is wanted for a machine that it cannot be given.
extern const config_part_t flux_part;

/// The stator flux above the blend, the deviation observer below.
extern const position_source_t flux_source;

/// The flux begins anew; where it keeps it goes on.
void flux_source_begin(const drive_t* d, bool keeps);

/// Sets the flux to what this angle, in whose frame the current is measured, lets expect.
void flux_source_follow(const drive_t* d, const estimator_output_t* now);

estimator_output_t flux_source_alone(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in);
estimator_output_t flux_source_beside(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in,
                                      const estimator_output_t* low);

/// flux_beside: a method beside a source that is right, from flux_low on; what the method says.
estimator_output_t flux_source_look_on(const drive_t* d, const estimator_input_t* in, const estimator_output_t* truth);

#endif

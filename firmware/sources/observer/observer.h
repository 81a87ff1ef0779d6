// The deviation observer and AVV as position sources (interfaces/source.h), and what other sources have of them.

#ifndef STILLSPIN_FIRMWARE_SOURCES_OBSERVER_OBSERVER_H
#define STILLSPIN_FIRMWARE_SOURCES_OBSERVER_OBSERVER_H

#include "firmware/interfaces/source.h"
#include "firmware/mode/mode.h"

extern const position_source_t observer_avv_source, avv_source, observer_source;

/// D of the zero vectors in the frame in use, A per period, by the sources that look for it.
extern int32_t source_deviation_q20;

/// In its slots: inverse inductances and match of the sensors, resistance and flux. Resistance and flux are learnt once
/// the drive runs; until then the sensors have that slot.
void source_learn(const drive_t* d, drive_estimate_t* e, const regression_t* r);

/// AVV, and what its regression says of the machine.
void source_step_avv(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in);

/// The deviation observer alone, and what its regression says of the machine.
estimator_output_t source_observer(const drive_t* d, drive_estimate_t* e, estimator_input_t* in);

#endif

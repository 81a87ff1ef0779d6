// The position sources (interfaces/source.h) and what they have of each other.

#ifndef STILLSPIN_FIRMWARE_SOURCES_SOURCES_H
#define STILLSPIN_FIRMWARE_SOURCES_SOURCES_H

#include "firmware/interfaces/source.h"
#include "firmware/mode/mode.h"

extern const position_source_t encoder_source, paper_source, observer_avv_source, avv_source, observer_source,
    flux_source;

/// D of the zero vectors in the frame in use, A per period, by the sources that look for it.
extern int32_t source_deviation_q20;

/// In its slots: inverse inductances and match of the sensors, resistance and flux. Resistance and flux are learnt once
/// the drive runs; until then the sensors have that slot.
void source_learn(drive_t* d, const regression_t* r);

/// AVV, and what its regression says of the machine.
void source_step_avv(drive_t* d, const estimator_input_t* in);

/// The deviation observer alone, and what its regression says of the machine.
estimator_output_t source_observer(drive_t* d, estimator_input_t* in);

#endif

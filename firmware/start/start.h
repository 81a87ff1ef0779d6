// The start: from READY to RUN.
//
// First the drive listens whether the shaft turns (two short circuits, flying.c). If it does, angle, polarity and
// speed come from the back-EMF and the drive runs on at that speed. If it stands, the axis comes from the saliency, the
// polarity from saturation where the machine's slopes are known and large enough, else from a small motion. What stays
// ambiguous is tried again with more current and then is a fault. A test whose current did not follow, because the DC
// link is too low for it, does not count: less current is tried, from the axis on.
//
// The same windows tell whether phases and current sensors are wired as they should be (estimators/wiring.h).
//
// With start_method 1 a shaft that stands is turned by a current vector instead (start/if_start/): that needs no
// saliency.

#ifndef STILLSPIN_FIRMWARE_START_START_H
#define STILLSPIN_FIRMWARE_START_START_H

#include "firmware/interfaces/state.h"

extern const state_t start_state;

#endif

// Position sources of the drive, beside the step that steps.h declares.

#ifndef STILLSPIN_FIRMWARE_DRIVE_POSITION_H
#define STILLSPIN_FIRMWARE_DRIVE_POSITION_H

#include "firmware/mode/mode.h"

/// 1 / n of n windows.
extern const int32_t position_per_windows_q30[ESTIMATOR_WINDOWS + 1];

/// Lets AVV start from this angle and speed: a start that looks for the axis has nothing else at work.
void position_preset_axis(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

/// Lets every estimator start from this angle and speed.
void position_preset(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

/// A vector in the frame that the control uses, in the frame of what the position source sees meanwhile.
static inline dq_t position_seen(const drive_t* d, dq_t vector) {
  return frame_moved(vector, d->position.seen.angle_bam - d->position.selected.angle_bam);
}

/// True where the blend has left the low-speed estimator, and nobody else needs it.
bool position_observer_rests(const drive_t* d);

/// Gives the shaft to the high-speed estimator alone, whatever the speed; the blend goes on from there.
void position_bumpless_transfer(drive_t* d);

/// The position source looks on, while somebody else says which angle is in use; or it rests, and has that.
static inline void position_look_on(drive_t* d, estimator_input_t* in) { d->position.seen = d->source->step(d, in); }
static inline void position_look_away(drive_t* d) { d->position.seen = d->position.selected; }

/// What the source has seen of a shaft that a vector turned is used from here on, and it goes on as it is.
void position_keep(drive_t* d);

/// True where the deviation observer reads the windows now.
bool position_observer_reads(const drive_t* d);

/// With two estimators by turns: below the blend a period without active windows says nothing to AVV.
static inline bool position_low_alone(const drive_t* d) {
  return blend_is_low(&d->position.blend) && d->samples.count <= 1u;
}

#endif

// Position sources of the drive, beside the step that steps.h declares.

#ifndef STILLSPIN_FIRMWARE_DRIVE_POSITION_H
#define STILLSPIN_FIRMWARE_DRIVE_POSITION_H

#include "firmware/mode/mode.h"

/// 1 / n of n windows.
extern const int32_t position_per_windows_q30[ESTIMATOR_WINDOWS + 1];

/// Lets AVV start from this angle and speed: a start that looks for the axis has nothing else at work.
void position_preset_axis(drive_estimate_t* e, uint32_t angle_bam, int32_t speed_bpp);

/// Lets every estimator start from this angle and speed.
void position_preset(const drive_t* d, drive_estimate_t* e, uint32_t angle_bam, int32_t speed_bpp);

/// A vector in the frame that the control uses, in the frame of what the position source sees meanwhile.
static inline dq_t position_seen(const drive_t* d, dq_t vector) {
  return frame_moved(vector, d->estimate.seen.angle_bam - d->estimate.selected.angle_bam);
}

/// True where the blend has left the low-speed estimator, and nobody else needs it.
bool position_observer_rests(const drive_t* d);

/// Gives the shaft to the high-speed estimator alone, whatever the speed; the blend goes on from there.
void position_bumpless_transfer(drive_estimate_t* e);

/// The position source looks on, while somebody else says which angle is in use; or it rests, and has that.
static inline void position_look_on(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  e->seen = d->source->step(d, e, in);
}
static inline void position_look_away(drive_estimate_t* e) { e->seen = e->selected; }

/// What the source has seen of a shaft that a vector turned is used from here on, and it goes on as it is.
void position_keep(const drive_t* d, drive_estimate_t* e);

/// The frame in use moves ahead of where it was; the source goes on seeing what it saw.
static inline void position_turn(drive_estimate_t* e, uint32_t ahead_bam) {
  position_look_away(e);
  e->selected.angle_bam += ahead_bam;
  e->measured_q20 = frame_moved(e->measured_q20, ahead_bam);
}

/// True where the deviation observer reads the windows now.
bool position_observer_reads(const drive_t* d);

/// With two estimators by turns: below the blend a period without active windows says nothing to AVV.
static inline bool position_low_alone(const drive_t* d) {
  return blend_is_low(&d->estimate.blend) && d->samples.count <= 1u;
}

#endif

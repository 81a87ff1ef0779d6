// Position sources of the drive, beside the step that drive.h declares.

#ifndef STILLSPIN_FIRMWARE_POSITION_H
#define STILLSPIN_FIRMWARE_POSITION_H

#include "firmware/drive.h"

/// Lets every estimator start from this angle and speed.
void position_preset(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

/// Makes the encoder's present count mean this angle. Reads the encoder.
void position_align_encoder(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

/// What is slow in this period: decided before it begins, so that nothing else long falls on it.
void position_next_turn(drive_t* d);

/// In this period the synchronism is judged; the deviation observer has just regressed its windows; the polarity's
/// watch follows the axis, or looks at the back-EMF.
bool position_judges_now(const drive_t* d);
bool position_has_regressed(const drive_t* d);
bool position_follows_axis_now(const drive_t* d);
bool position_looks_at_emf_now(const drive_t* d);

/// Electrical angle of an encoder count whose zero lies on phase a.
uint32_t position_encoder_angle(uint32_t count, int32_t pole_pairs, int32_t counts_per_turn);

#endif

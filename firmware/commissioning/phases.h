// The phases of the state COMMISSION (sequence.c), each in its own file.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_PHASES_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_PHASES_H

#include "firmware/commissioning/commissioning.h"
#include "firmware/mode/mode.h"

/// Background level: evaluation.
void commissioning_service(const drive_t* d);
bool commissioning_align(drive_t* d);                     // commissioning/hold.c
bool commissioning_climb(drive_t* d);                     // commissioning/staircase.c
bool commissioning_map(drive_t* d);                       // commissioning/map.c
int32_t commissioning_map_done(const map_t* m);           // share of it in time, per mille
int32_t map_level_q20(const map_t* m, uint16_t level);    // its current, A
bool commissioning_spin(drive_t* d);                      // commissioning/spin.c
void commissioning_hold(drive_t* d);                      // keeps the shaft at target_bam by i_q
void commissioning_set_d(drive_t* d, int32_t level_q20);  // i_d reference, with a limited slope
/// It samples so from a few periods later on.
void commissioning_sample(commissioning_sampling_t how);
/// A pair of windows at rest and without current, for the inductances there.
void commissioning_add_still(const drive_t* d);
/// Angle and speed while the shaft is held (commissioning/hold.c).
estimator_output_t commissioning_estimate(const drive_t* d, drive_estimate_t* e, estimator_input_t* in);
/// Whether the period has two windows under opposite vectors.
bool commissioning_has_pair(const drive_t* d);
/// One of them (0, 1) against the model, in the frame that it was turned into.
deviation_t commissioning_window(const drive_t* d, uint16_t k);
/// Both to the sums of a tensor; false when there are none.
bool commissioning_add_pair(const drive_t* d, tensor_sums_t* sums);

#endif

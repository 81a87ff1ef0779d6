// The reference encoder as a position source: what it remembers, and its constants.

#ifndef STILLSPIN_FIRMWARE_SOURCES_ENCODER_H
#define STILLSPIN_FIRMWARE_SOURCES_ENCODER_H

#include "estimators/tracking_observer.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/mode/mode.h"

typedef struct {
  tracking_observer_t observer;
  uint32_t offset_bam;     // electrical angle at count 0, found at the start
  uint32_t aligned_bam;    // where it was found
  uint32_t trim_bam;       // deliberate turn of its angle
  uint32_t per_count_bam;  // electrical angle of a count
  int32_t counts;          // of a turn, that the board's counter is set up for
  bool beside_flux;        // which is compared with it, in the place of AVV
  bool beside_avv;         // which has active vectors that are long enough to sample in
} encoder_t;

extern encoder_t encoder;
extern const config_part_t encoder_part;

/// The encoder, with a flux or AVV that looks on.
extern const position_source_t encoder_source;

/// As after power-on.
void encoder_reset(void);

/// Background level, in every pass: the board's counter is that of the parameter, which changes at rest alone.
void encoder_service(void);

/// Electrical angle of an encoder count whose zero lies on phase a.
uint32_t encoder_angle(uint32_t count, int32_t pole_pairs, int32_t counts_per_turn);

#endif

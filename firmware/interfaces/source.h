// A position source: where angle and speed come from while the shaft turns. Its state is its own.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_SOURCE_H
#define STILLSPIN_FIRMWARE_INTERFACES_SOURCE_H

#include "estimators/estimator.h"
#include "svpwm/modulator.h"

struct drive;
struct estimate;

/// What others have to know of a source.
enum {
  SOURCE_MEASURES = 1,      // the angle is measured, not estimated
  SOURCE_SINGLE = 2,        // one estimator at all speeds
  SOURCE_OBSERVES = 4,      // the deviation observer is at work at low speed
  SOURCE_READS = 8,         // and it reads the windows, not AVV
  SOURCE_HANDS_OVER = 16,   // above the blend it rests, and the other has the shaft alone
  SOURCE_BLENDS = 32,       // two estimators, both meant to be right only between the ends of the blend
  SOURCE_BESIDE = 64,       // two estimators, both meant to be right at any speed
  SOURCE_ALTERNATES = 128,  // two estimators have the windows in turn; the blend goes by a speed from the start on
  SOURCE_AVV_FIRST = 256,   // it is AVV that looks at the windows first
  SOURCE_ACTIVE = 512       // AVV has to see two active vectors in every period
};

/// Of the parameter `excitation`: the source says which pulses there are.
#define EXCITATION_BY_SOURCE 3

typedef struct {
  /// Of a period: angle and speed. What it has for itself of the drive's estimate (interfaces/period.h), and what it
  /// learns of machine and sensors, it writes; the drive is there to be read.
  estimator_output_t (*step)(const struct drive* d, struct estimate* e, estimator_input_t* in);
  /// The pulses it wants where the parameter `excitation` leaves that to it; NULL: alternating.
  excitation_t (*excitation)(const struct drive* d);
  /// Highest i_d with which it sees; NULL: any.
  int32_t (*highest_d_q20)(const struct drive* d);
  /// Goes along with an angle that somebody else knows; NULL: need not.
  void (*follow)(const struct drive* d, const estimator_output_t* now);
  /// Begins anew from angle and speed in use, or goes on with what it has seen while a vector turned the shaft; so does
  /// the flux, whichever source has the shaft, as it may look on. NULL: has nothing of its own.
  void (*begin)(const struct drive* d, bool keeps);
  /// Whether what it measures turns the other way than the windows since then. Only soon after a start, within an
  /// electrical turn. NULL: it measures nothing.
  bool (*is_reversed)(const struct drive* d);
  uint16_t traits;
  uint16_t windows;  // of a period that it looks at, up to SVPWM_WINDOWS
} position_source_t;

/// By the values of the parameter position_source (editions/).
extern const position_source_t* const position_sources[];
/// Before the shaft turns: finds the axis of a rotor at rest, and leaves in `avv` what the start reads.
extern const position_source_t* const edition_start_source;
/// In a commissioning's spin, and where this edition leaves out the one that the parameter selects.
extern const position_source_t* const edition_default_source;

/// By the same: which of its values a source has there, from 1; 0 where it has but one. Of an edition without a source
/// of several there is one 0, and nobody who asks.
extern const int16_t position_source_variants[];

#endif

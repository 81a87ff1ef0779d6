// Watches, after a start, whether the back-EMF has the sign that the polarity found lets expect; see polarity_watch.c.

#ifndef STILLSPIN_FIRMWARE_DRIVE_POLARITY_WATCH_H
#define STILLSPIN_FIRMWARE_DRIVE_POLARITY_WATCH_H

#include "estimators/emf_sign.h"
#include "estimators/tracking_observer.h"
#include "firmware/mode/mode.h"

typedef struct {
  bool open;  // not answered since the start
  tracking_observer_t axis;
  uint16_t axis_periods;  // since it was last moved on
  uint16_t then_periods;  // from there to when the windows were regressed
  bool samples_invalid;   // when it was to be seen
  emf_sign_t sign;
  dq_t voltage_q12;  // sum of the commands since the back-EMF was last looked at, V
  uint16_t periods;  // that long ago
} polarity_watch_t;

extern polarity_watch_t polarity_watch;

/// From the start's end on; the step is true when the back-EMF says that the magnet is the other way round.
void polarity_watch_begin(uint32_t angle_bam, int32_t speed_bpp);
void polarity_watch_end(void);
bool polarity_watch_step(const drive_t* d);
bool polarity_watch_suspects(void);
static inline bool polarity_watch_is_awake(const drive_t* d) { return polarity_watch.open && d->state == DRIVE_RUN; }

#endif

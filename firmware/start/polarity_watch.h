// Watches, after a start, whether the back-EMF has the sign that the polarity found lets expect; see polarity_watch.c.

#ifndef STILLSPIN_FIRMWARE_START_POLARITY_WATCH_H
#define STILLSPIN_FIRMWARE_START_POLARITY_WATCH_H

#include "estimators/emf_sign.h"
#include "estimators/tracking_observer.h"

typedef struct {
  bool open;  // not answered since the start
  tracking_observer_t axis;
  emf_sign_t sign;
} polarity_watch_t;

#endif

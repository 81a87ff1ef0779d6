// What the features have to tell each other, and whoever asks how the drive is: written by the one who knows, read by
// all. What an edition has not stays at zero.

#ifndef STILLSPIN_FIRMWARE_API_STATUS_H
#define STILLSPIN_FIRMWARE_API_STATUS_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef struct {
  bool stepped;                 // a host steps the drive: it and its parameters are a simulation's (hil/)
  volatile uint16_t heartbeat;  // meanwhile, in the place of the drive's own
  uint16_t store_work;          // what the parameter store is at; 0: nothing (store/)
} feature_status_t;

extern feature_status_t feature_status;

#if defined(__cplusplus)
}
#endif

#endif

// What the features have to tell each other, and whoever asks how the drive is: written by the one who knows, read by
// all. What an edition has not stays at zero, but for the store.

#ifndef STILLSPIN_FIRMWARE_API_STATUS_H
#define STILLSPIN_FIRMWARE_API_STATUS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/octets.h"
#include "firmware/interfaces/service.h"
#include "firmware/text/packed_text.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define UNSAVED_UNKNOWN 255u
#define STORE_STATE_ABSENT 8u  // of CATALOGUE_STORE: nothing can be saved

typedef struct {
  bool stepped;                 // a host steps the drive: it and its parameters are a simulation's (hil/)
  bool loading;                 // the parameters are being read: BOOT goes on (store/)
  volatile uint16_t heartbeat;  // meanwhile, in the place of the drive's own
  uint16_t store_work;          // what the parameter store is at; 0: nothing (store/)
  uint16_t refusals;            // commands that were typed and not carried out (console/)
  uint16_t wiring;              // CATALOGUE_WIRING, what the last start has seen beside its fault (start/)
  // As of the last status_update.
  uint16_t store_state;             // CATALOGUE_STORE
  uint16_t store_progress;          // percent
  uint16_t unsaved;                 // parameters that are not what the next power-on will have; UNSAVED_UNKNOWN
  uint16_t commissioning_outcome;   // CATALOGUE_COMMISSIONING
  uint16_t commissioning_phase;     // CATALOGUE_PHASE
  uint16_t commissioning_progress;  // per mille
} feature_status_t;

extern feature_status_t feature_status;

/// Background level: everyone writes what is asked for too seldom to be written all the time.
void status_update(void);
/// Those who do (editions/).
extern service_t* const edition_status_updates[];

/// A line about how something is, for people.
typedef struct {
  packed_text_t title;
  void (*put)(octet_writer_t* w);
} status_line_t;
/// Those of the edition, NULL behind the last one (editions/).
extern const status_line_t* const edition_status_lines[];

#if defined(__cplusplus)
}
#endif

#endif

#include "firmware/api/status.h"

#include <stddef.h>

feature_status_t feature_status;

void status_update(void) {
  feature_status.store_state = STORE_STATE_ABSENT;  // unless there is a store
  feature_status.store_progress = 100;
  for (uint16_t k = 0; edition_status_updates[k] != NULL; k++) edition_status_updates[k]();
}

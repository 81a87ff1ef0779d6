#include "firmware/api/status.h"

#include <stddef.h>

feature_status_t feature_status;

void status_update(void) {
  for (uint16_t k = 0; edition_status_updates[k] != NULL; k++) edition_status_updates[k]();
}

// What the parameters say of the look for a turning shaft.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/start/flying/flying.h"

static void take(void) {
  start_ways.listens = parameters.flying_start != 0;
  start_ways.checks_wiring = parameters.wiring_check != 0;
}

const config_part_t flying_part = {NULL, take};

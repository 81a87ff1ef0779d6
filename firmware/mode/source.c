// Which position source is chosen, by its parameter.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"

static const position_source_t* named(void) { return position_sources[parameters.position_source]; }

bool drive_source_is_left_out(void) { return named() == NULL; }

const position_source_t* drive_source_wanted(void) {
  return drive_source_is_left_out() ? position_sources[POSITION_OBSERVER] : named();
}

void drive_choose_source(void) { drive.source = drive_source_wanted(); }

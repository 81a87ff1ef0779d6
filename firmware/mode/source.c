// Which position source is selected, by its parameter.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"

static const position_source_t* named(const parameters_t* p) { return position_sources[p->position_source]; }

bool drive_source_is_left_out(const parameters_t* p) { return named(p) == NULL; }

const position_source_t* drive_source_selected(void) {
  return drive_source_is_left_out(&parameters) ? position_sources[POSITION_OBSERVER] : named(&parameters);
}

bool drive_source_selected_has(uint16_t trait) { return (drive_source_selected()->traits & trait) != 0u; }

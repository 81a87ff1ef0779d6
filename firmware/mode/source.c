// Which position source is selected, by its parameter.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"

static const position_source_t* named(const parameters_t* p) { return position_sources[p->position_source]; }

bool drive_source_is_left_out(const parameters_t* p) { return named(p) == NULL; }

const position_source_t* drive_source_selected(void) {
  const position_source_t* const source = named(&parameters);
  return (source != NULL) ? source : edition_default_source;
}

bool drive_source_selected_has(uint16_t trait) { return (drive_source_selected()->traits & trait) != 0u; }

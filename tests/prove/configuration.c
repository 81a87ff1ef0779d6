// What is made of the parameters, each anywhere in the range that the table gives it: whether they fit together, and if
// so the configuration of the whole drive.

#include <stddef.h>

#include "firmware/config/config.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/flux/flux.h"
#include "tests/prove/any_parameters.h"

config_part_t* const edition_config_parts[] = {flux_source_load, NULL};

void prove_configuration(void) {
  const drive_config_t* made = 0;
  any_parameters();
  (void)drive_config_or_conflict(&made);
}

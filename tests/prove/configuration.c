// What is made of the parameters, each anywhere in the range that the table gives it: whether they fit together, and if
// so the configuration of the whole drive.

#include <stddef.h>

#include "firmware/config/rules.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/paper/paper.h"
#include "firmware/start/if_start/if_start.h"
#include "tests/prove/any_parameters.h"

const config_part_t* const edition_config_parts[] = {&flux_part, &encoder_part, &if_ramp_part, &paper_part, NULL};

void prove_configuration(void) {
  any_parameters();
  (void)parameter_conflict();
}

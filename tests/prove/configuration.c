// What is made of the parameters, each anywhere in the range that the table gives it: whether they fit together, and if
// so the configuration of the whole drive.

#include "firmware/drive.h"
#include "firmware/parameters.h"
#include "tests/prove/any.h"

static void any_parameters(void) {
  int32_t* const values = (int32_t*)(void*)&parameters;
  //@ loop unroll 200;
  for (uint16_t k = 0; k < parameter_count(); k++) {
    values[k] = any_from(parameter_info(k)->minimum, parameter_info(k)->maximum);
  }
}

void prove_configuration(void) {
  const drive_config_t* made = 0;
  any_parameters();
  (void)drive_config_or_conflict(&made);
}

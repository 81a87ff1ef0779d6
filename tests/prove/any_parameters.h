// Parameters with every value anywhere in the range that the table gives it.

#ifndef STILLSPIN_TESTS_PROVE_ANY_PARAMETERS_H
#define STILLSPIN_TESTS_PROVE_ANY_PARAMETERS_H

#include "firmware/dictionary/parameters.h"
#include "tests/prove/any.h"

static inline void any_parameters(void) {
  int32_t* const values = (int32_t*)(void*)&parameters;
  //@ loop unroll 200;
  for (uint16_t k = 0; k < parameter_count(); k++) {
    values[k] = any_from(parameter_info(k)->minimum, parameter_info(k)->maximum);
  }
}

#endif

// The stator-flux family with any method, cut-off and adaptation.

#ifndef STILLSPIN_TESTS_PROVE_ANY_FLUX_H
#define STILLSPIN_TESTS_PROVE_ANY_FLUX_H

#include "estimators/flux_observer.h"
#include "tests/prove/any_model.h"

static inline void any_flux(flux_observer_config_t* c) {
  c->method = (flux_method_t)(any_u16 & 3u);
  c->is_plain = any_bool();
  c->is_printed = any_bool();
  c->cutoff_q30 = any_from(107374L, 16106127L);
  c->bandwidth_q30 = any_from(107374L, 107374182L);
  c->unknown_voltage_q20 = any_from(0, 2 * AMPERES_Q20);
  c->adaptation_periods = (uint16_t)any_from(1, 1000);
  c->adaptation.saturation_q24 = any_from(0, 16777216L);
  c->adaptation.lowest_bpp = any_from(1, INT32_MAX);
  c->adaptation.current_q24 = any_from(167772L, 16777216L);
  c->adaptation.inductance_q30 = any_from(0, 1073741824L);
  c->adaptation.magnet_q30 = any_from(0, 1073741824L);
}

#endif

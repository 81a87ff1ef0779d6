// A drive whose configuration a test makes of parameters.

#ifndef STILLSPIN_TESTS_FIRMWARE_DRIVE_CONFIG_UNITS_HPP
#define STILLSPIN_TESTS_FIRMWARE_DRIVE_CONFIG_UNITS_HPP

#include <cstring>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "estimators/zvv.h"
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/paper/paper.h"
#include "firmware/start/if_start/if_start.h"
}

namespace stillspin::test {

constexpr double kBppPerRpm = 4.0 / 60.0 * kPeriod * 4294967296.0;

class Units : public Drive {
 protected:
  /// The configuration of the parameters as they are.
  static const drive_config_t& made() {
    static drive_config_t c;
    EXPECT_TRUE(drive_config_load(&c));
    return c;
  }
  static const flux_observer_config_t& made_flux() {
    (void)made();
    return flux_config;
  }
  static bool refused() { return drive_config_make() != PACKED_NONE; }
};

inline void expect_near_share(double value, double wanted, double share) {
  EXPECT_NEAR(value, wanted, std::fabs(share * wanted));
}

}  // namespace stillspin::test

#endif

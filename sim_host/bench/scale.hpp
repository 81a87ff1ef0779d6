// What an ampere and a volt of the drive's formats are (firmware/dictionary/units.h), for values that are not in a
// drive yet.

#ifndef STILLSPIN_SIM_HOST_BENCH_SCALE_HPP
#define STILLSPIN_SIM_HOST_BENCH_SCALE_HPP

#include <map>
#include <string>

#include "firmware/dictionary/parameters.h"

namespace stillspin::bench {

/// The parameters current_scale and voltage_scale.
struct Scale {
  int current = 0;
  int voltage = 0;

  /// As a set of parameters has them, by name.
  static Scale of(const std::map<std::string, double>& parameters);

  /// Fractional bits of a raw value in the parameter's unit.
  int q(const parameter_info_t& p) const;
  /// The value in the parameter's unit.
  double user(const parameter_info_t& p, std::int32_t raw) const;
};

}  // namespace stillspin::bench

#endif

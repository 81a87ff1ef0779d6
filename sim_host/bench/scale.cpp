#include "sim_host/bench/scale.hpp"

#include <cmath>

#include "firmware/dictionary/units.h"

namespace stillspin::bench {
namespace {

struct Powers {
  int current, voltage;
};

#define UNIT(unit, text, current, voltage) {current, voltage},
constexpr Powers kPowers[] = {
#include "firmware/dictionary/unit_list.h"
};
#undef UNIT

int whole(const std::map<std::string, double>& parameters, const char* name) {
  const auto found = parameters.find(name);
  return found == parameters.end() ? 0 : static_cast<int>(std::lround(found->second));
}

}  // namespace

Scale Scale::of(const std::map<std::string, double>& parameters) {
  return {whole(parameters, "current_scale"), whole(parameters, "voltage_scale")};
}

int Scale::q(const parameter_info_t& p) const {
  const Powers& powers = kPowers[p.unit];
  return p.q - powers.current * current - powers.voltage * voltage;
}

double Scale::user(const parameter_info_t& p, std::int32_t raw) const { return std::ldexp(raw, -q(p)); }

}  // namespace stillspin::bench

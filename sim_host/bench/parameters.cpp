#include "firmware/dictionary/parameters.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "firmware/config/rules.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "sim_host/bench/firmware_lease.hpp"
#include "sim_host/bench/run.hpp"
#include "sim_host/bench/texts.hpp"

namespace stillspin::bench {
namespace {

const parameter_info_t* find(const std::string& name) {
  for (std::uint16_t k = 0; k < parameter_count(); k++) {
    if (name == text_of(parameter_name(parameter_info(k)))) return parameter_info(k);
  }
  return nullptr;
}

}  // namespace

std::int32_t parameter_raw(const std::string& name, double value, const Scale& scale, unsigned& id) {
  const parameter_info_t* info = find(name);
  if (info == nullptr) throw std::invalid_argument("there is no firmware parameter '" + name + "'");
  id = info->id;
  const double raw = std::round(std::ldexp(value, scale.q(*info)));
  if (std::isfinite(raw) && raw >= parameter_minimum(info) && raw <= parameter_maximum(info))
    return static_cast<std::int32_t>(raw);
  std::ostringstream text;
  text << "firmware parameter " << name << " = " << value << ": out of range, allowed is "
       << scale.user(*info, parameter_minimum(info)) << " to " << scale.user(*info, parameter_maximum(info)) << " "
       << text_of(parameter_unit(info));
  throw std::invalid_argument(text.str());
}

void check_parameters(const std::map<std::string, double>& parameters) {
  const FirmwareLease lease;
  drive_reset();
  const Scale scale = Scale::of(parameters);
  for (const auto& [name, value] : parameters) {
    unsigned id = 0;
    const std::int32_t raw = parameter_raw(name, value, scale, id);
    (void)parameter_set(static_cast<std::uint16_t>(id), raw);
  }
  const packed_text_t conflict = parameter_conflict();
  if (conflict != PACKED_NONE) throw std::invalid_argument("firmware parameters: " + text_of(conflict));
}

}  // namespace stillspin::bench

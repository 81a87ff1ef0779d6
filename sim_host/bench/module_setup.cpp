#include "sim_host/bench/module_setup.hpp"

#include <nanobind/stl/string.h>

#include "sim_host/plant/flux_map.hpp"

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

// What a nameplate would say of the machine, and how good the table is.
nb::dict flux_map_facts(const std::string& path) {
  const auto map = plant::FluxMap::read(path);
  const plant::FluxMap::Value zero = map->at(0.0, 0.0);
  nb::dict found;
  found["inductance_d"] = zero.ldd;
  found["inductance_q"] = zero.lqq;
  found["magnet_flux"] = zero.psi_d;
  found["magnet_flux_q"] = zero.psi_q;
  found["misfit"] = map->misfit();
  return found;
}

}  // namespace

void bind_flux_map(nb::module_& m) {
  m.def("flux_map", &flux_map_facts, nb::arg("path"),
        "Inductances (H) and flux (Vs) at zero current of a table, and its largest misfit (Vs); see core.py.");
}

Setup setup_from(const nb::dict& plant, std::uint64_t seed) {
  Setup setup;
  for (const auto& [section, keys] : plant) {
    for (const auto& [key, value] : nb::cast<nb::dict>(keys)) {
      const std::string s = nb::cast<std::string>(section);
      const std::string k = nb::cast<std::string>(key);
      if (nb::isinstance<nb::str>(value)) {
        set_entry(setup, s, k, nb::cast<std::string>(value));
      } else {
        set_entry(setup, s, k, nb::cast<double>(value));
      }
    }
  }
  setup.nominal.adc.seed = seed;
  return setup;
}

}  // namespace stillspin::bench

#include "sim_host/bench/module_setup.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <stdexcept>

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

double chosen(const std::string& section, const std::string& key, const std::string& word) {
  for (const Entry& e : entries()) {
    if (section != e.section || key != e.key || e.choices == nullptr) continue;
    const auto found = std::find(e.choices->begin(), e.choices->end(), word);
    if (found != e.choices->end()) return static_cast<double>(found - e.choices->begin());
  }
  throw std::invalid_argument(section + "." + key + " = '" + word + "': not a choice");
}

double number(const std::string& section, const std::string& key, nb::handle value) {
  if (nb::isinstance<nb::str>(value)) return chosen(section, key, nb::cast<std::string>(value));
  return nb::cast<double>(value);
}

}  // namespace

Setup setup_from(const nb::dict& plant, std::uint64_t seed) {
  Setup setup;
  for (const auto& [section, keys] : plant) {
    for (const auto& [key, value] : nb::cast<nb::dict>(keys)) {
      const std::string s = nb::cast<std::string>(section);
      const std::string k = nb::cast<std::string>(key);
      set_entry(setup, s, k, number(s, k, value));
    }
  }
  setup.nominal.adc.seed = seed;
  return setup;
}

}  // namespace stillspin::bench

// The plant as a table of named entries: what profiles and command lines may set, with units, ranges and meaning.
//
// The one list of plant entries: it fills plant::PlantConfig and is what the Python side shows, checks and documents.

#ifndef STILLSPIN_SIM_HOST_BENCH_SETUP_HPP
#define STILLSPIN_SIM_HOST_BENCH_SETUP_HPP

#include <string>
#include <vector>

#include "sim_host/bench/board_options.hpp"
#include "sim_host/bench/fault_plan.hpp"
#include "sim_host/plant/config.hpp"

namespace stillspin::bench {

/// True minus nominal, as a fraction of nominal.
struct ParameterError {
  double resistance = 0.0;
  double inductance_d = 0.0;
  double inductance_q = 0.0;
  double magnet_flux = 0.0;
  double inertia = 0.0;
};

/// A plant with nominal parameters and how far the true ones are from them.
struct Setup {
  /// With the ranges of the board in use (board_description.cpp).
  Setup();

  plant::PlantConfig nominal = plant::PlantConfig::ideal();
  ParameterError error;
  FaultPlan fault;
  BoardOptions board;
  bool brake_until_run = false;  // a holding brake that opens when the drive has finished its start procedure
  double solver = 0;  // index into the choices of solver.method: SUNDIALS unless the fast integrator is asked for

  /// The plant with the true parameters, validated (std::invalid_argument names entry, value and range).
  plant::PlantConfig plant() const;
};

enum class EntryKind { kNumber, kWhole, kSwitch, kChoice, kText };

struct Entry {
  const char* section;
  const char* key;
  const char* unit;
  EntryKind kind;
  double minimum;
  double maximum;
  double (*get)(const Setup&);
  void (*set)(Setup&, double);
  const char* help;
  const std::vector<std::string>* choices;  // words for the values of a kChoice entry, else null
  std::string& (*text)(Setup&) = nullptr;   // of a kText entry, which has no number, else null
};

/// All entries, grouped by section.
const std::vector<Entry>& entries();

/// Sets one entry; throws std::invalid_argument when it does not exist or the value is out of range.
void set_entry(Setup& setup, const std::string& section, const std::string& key, double value);

/// The same by a word: one of the choices, or the text.
void set_entry(Setup& setup, const std::string& section, const std::string& key, const std::string& word);

}  // namespace stillspin::bench

#endif

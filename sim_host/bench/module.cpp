// The Python module stillspin._core: the virtual drive as functions. Python's side of the contract is core.py.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <memory>

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"
#include "sim_host/bench/commission.hpp"
#include "sim_host/bench/module_setup.hpp"
#include "sim_host/bench/replay.hpp"
#include "sim_host/bench/run.hpp"
#include "sim_host/bench/texts.hpp"

namespace nb = nanobind;
using namespace stillspin::bench;
using stillspin::plant::Tick;

namespace {

nb::object array(std::vector<double> values) {
  auto* data = new std::vector<double>(std::move(values));
  nb::capsule owner(data, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<1>>(data->data(), {data->size()}, owner));
}

nb::dict signals_of(RunResult& result) {
  nb::dict signals;
  for (std::size_t k = 0; k < columns().size(); k++) signals[columns()[k].name] = array(std::move(result.values[k]));
  return signals;
}

nb::dict waveform_of(RunResult& result) {
  nb::dict tables;
  for (auto& [name, table] : result.waveform) {
    nb::dict columns_of;
    for (auto& [column, values] : table) columns_of[column.c_str()] = array(std::move(values));
    tables[name.c_str()] = columns_of;
  }
  return tables;
}

struct PythonResult {
  nb::dict signals;
  nb::dict waveform;
  bool completed;
  std::string reason;
  std::vector<std::pair<double, std::string>> faults;
  std::map<std::string, double> stats;
};

// Asks Python now and then; a signal such as Ctrl-C ends the run.
std::function<bool(double)> progress_of(const nb::object& callback) {
  return [callback](double share) {
    nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    return callback.is_none() || nb::cast<bool>(callback(share));
  };
}

PythonResult run_in_python(const nb::dict& plant, const std::map<std::string, double>& parameters,
                           const std::vector<std::tuple<double, std::string, double>>& commands,
                           const std::vector<std::pair<double, double>>& load, double duration, double max_start,
                           int record_every, const std::tuple<double, double, int>& waveform, std::uint64_t seed,
                           const nb::object& progress, bool record_start, const nb::object& recording) {
  RunRequest request;
  request.setup = setup_from(plant, seed);
  request.parameters = parameters;
  for (const auto& [time, what, value] : commands) request.commands.push_back({time, what, value});
  request.load = load;
  request.duration = duration;
  request.max_start = max_start;
  request.record_every = record_every;
  request.waveform = {std::get<0>(waveform), std::get<1>(waveform), std::get<2>(waveform)};
  request.record_start = record_start;
  request.progress = progress_of(progress);
  request.recording = recording_sink_of(recording);
  RunResult result;
  {
    nb::gil_scoped_release release;
    result = run(request);
  }
  return {signals_of(result), waveform_of(result), result.completed, result.reason, result.faults, result.stats};
}

nb::dict replay_in_python(const nb::dict& plant, const std::vector<std::tuple<Tick, int, bool, bool>>& edges,
                          const std::vector<std::pair<Tick, double>>& load, const std::vector<Tick>& at) {
  ReplayRequest request;
  request.setup = setup_from(plant, 1);
  for (const auto& [tick, leg, upper, lower] : edges) request.edges.push_back({tick, leg, upper, lower});
  for (const auto& [tick, torque] : load) request.load.push_back({tick, torque});
  request.at = at;
  std::vector<std::vector<double>> values;
  {
    nb::gil_scoped_release release;
    values = replay(request);
  }
  nb::dict result;
  for (std::size_t k = 0; k < values.size(); k++) result[replay_columns()[k].name] = array(std::move(values[k]));
  return result;
}

struct PythonCommissioning {
  nb::list values;
  bool completed;
  std::string reason;
  std::map<std::string, double> stats;
};

nb::list identified_rows(const CommissionResult& result) {
  nb::list rows;
  for (const Identified& v : result.values) {
    nb::dict row;
    row["name"] = v.name;
    row["unit"] = v.unit;
    row["decimals"] = v.decimals;
    row["before"] = v.before;
    row["value"] = v.value;
    row["used"] = v.used;
    row["words"] = v.words;
    rows.append(row);
  }
  return rows;
}

PythonCommissioning commission_in_python(const nb::dict& plant, const std::map<std::string, double>& parameters,
                                         double limit, std::uint64_t seed, const nb::object& progress,
                                         const nb::object& recording) {
  CommissionRequest request;
  request.setup = setup_from(plant, seed);
  request.parameters = parameters;
  request.limit = limit;
  request.progress = [progress](double share, const std::string& phase) {
    nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    return progress.is_none() || nb::cast<bool>(progress(share, phase));
  };
  request.recording = recording_sink_of(recording);
  CommissionResult result;
  {
    nb::gil_scoped_release release;
    result = commission(request);
  }
  return {identified_rows(result), result.completed, result.reason, result.stats};
}

nb::list parameter_rows() {
  nb::list rows;
  for (std::uint16_t k = 0; k < parameter_count(); k++) {
    const parameter_info_t* p = parameter_info(k);
    nb::dict row;
    row["id"] = p->id;
    row["name"] = text_of(parameter_name(p));
    row["unit"] = text_of(parameter_unit(p));
    row["decimals"] = p->decimals;
    row["whole"] = p->q == 0;
    row["minimum"] = std::ldexp(parameter_minimum(p), -p->q);
    row["maximum"] = std::ldexp(parameter_maximum(p), -p->q);
    row["default"] = std::ldexp(parameter_initial(p), -p->q);
    row["access"] = p->access == PARAMETER_ALWAYS ? "always" : "stopped";
    row["help"] = text_of(parameter_meaning(p));
    rows.append(row);
  }
  return rows;
}

nb::list signal_rows() {
  nb::list rows;
  for (const ColumnInfo& c : columns()) {
    nb::dict row;
    row["name"] = c.name;
    row["unit"] = c.unit;
    row["help"] = c.meaning;
    rows.append(row);
  }
  return rows;
}

// Of all parameters and signals, whatever the edition.
nb::list dictionary_names() {
  nb::list names;
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) names.append(#name);
#include "firmware/dictionary/all_parameters.h"
#undef PARAMETER
#define SIGNAL(name, unit, q, of, value, meaning) names.append(#name);
#include "firmware/dictionary/all_signals.h"
#undef SIGNAL
  return names;
}

nb::object default_of(const Entry& e) {
  const double value = e.get(Setup());
  switch (e.kind) {
    case EntryKind::kSwitch:
      return nb::bool_(value != 0.0);
    case EntryKind::kWhole:
      return nb::int_(static_cast<long>(value));
    case EntryKind::kChoice:
      return nb::str((*e.choices)[static_cast<std::size_t>(value)].c_str());
    case EntryKind::kText:
      return nb::str("");
    default:
      return nb::float_(value);
  }
}

nb::dict schema() {
  nb::dict sections;
  for (const Entry& e : entries()) {
    if (!sections.contains(e.section)) sections[e.section] = nb::dict();
    nb::dict row;
    row["unit"] = e.unit;
    row["minimum"] = e.minimum;
    row["maximum"] = e.maximum;
    row["default"] = default_of(e);
    row["help"] = e.help;
    if (e.kind == EntryKind::kChoice) row["choices"] = *e.choices;
    nb::cast<nb::dict>(sections[e.section])[e.key] = row;
  }
  return sections;
}

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "The virtual drive: firmware, virtual F2808 and plant in one process.";
  nb::class_<PythonResult>(m, "RunResult")
      .def_ro("signals", &PythonResult::signals)
      .def_ro("waveform", &PythonResult::waveform)
      .def_ro("completed", &PythonResult::completed)
      .def_ro("reason", &PythonResult::reason)
      .def_ro("faults", &PythonResult::faults)
      .def_ro("stats", &PythonResult::stats);
  m.def("run", &run_in_python, nb::kw_only(), nb::arg("plant"), nb::arg("parameters"), nb::arg("commands"),
        nb::arg("load"), nb::arg("duration"), nb::arg("max_start"), nb::arg("record_every"), nb::arg("waveform"),
        nb::arg("seed"), nb::arg("progress").none(), nb::arg("record_start") = false, nb::arg("recording") = nb::none(),
        "One run of the virtual drive; see core.py.");
  nb::class_<PythonCommissioning>(m, "CommissioningResult")
      .def_ro("values", &PythonCommissioning::values)
      .def_ro("completed", &PythonCommissioning::completed)
      .def_ro("reason", &PythonCommissioning::reason)
      .def_ro("stats", &PythonCommissioning::stats);
  m.def("commission", &commission_in_python, nb::kw_only(), nb::arg("plant"), nb::arg("parameters"), nb::arg("limit"),
        nb::arg("seed"), nb::arg("progress").none(), nb::arg("recording") = nb::none(),
        "The firmware's commissioning on the virtual drive; see core.py.");
  m.def("parameters", &parameter_rows, "The firmware's parameter table, as it is where both scales are 0.");
  m.def("names", &dictionary_names, "Of all parameters and signals of the firmware, whatever the edition.");
  m.def("check_parameters", &check_parameters, nb::arg("parameters"),
        "Raises ValueError when firmware parameters are unknown, out of range or do not fit together.");
  m.def("signals", &signal_rows, "Name, unit and meaning of the recorded columns.");
  m.def("plant_schema", &schema, "Section -> key -> unit, minimum, maximum, default, help of the plant.");
  m.def("replay", &replay_in_python, nb::kw_only(), nb::arg("plant"), nb::arg("edges"), nb::arg("load"), nb::arg("at"),
        "The plant alone under a given sequence of gate edges; see core.py.");
  bind_virtual_board(m);
  bind_step_loop(m);
  bind_loader_board(m);
  bind_can_messages(m);
  bind_flux_map(m);
}

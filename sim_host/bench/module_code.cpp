// What Python has of a board that executes an image; core_board.py has the contract.

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "sim_host/bench/module_board.hpp"

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

using c28x::Profile;
using c28x::Registers;
using Self = const PythonBoard&;

nb::dict code(Self self) {
  const c28x::Core& core = self.board().code();
  nb::dict values;
  values["cycles"] = core.cycles;
  values["instructions"] = core.instructions;
  values["waited_for_registers"] = core.waits.registers;
  values["waited_for_data"] = core.waits.data;
  values["waited_for_fetches"] = core.waits.fetch;
  values["pc"] = core.r.pc;
  values["sp"] = core.r.sp;
  return values;
}

const Profile& profile(Self self) {
  const Profile* noted = self.board().code().profile();
  if (noted == nullptr) throw std::logic_error("nothing was noted: profile() comes first");
  return *noted;
}

// By address: cycles, and of them those waited for registers, data, fetches. By (vector, routine): cycles of each
// interrupt. The highest stack pointer.
nb::tuple spent(Self self) {
  const Profile& noted = profile(self);
  nb::dict cycles;
  for (std::uint32_t k = 0; k < noted.spent.size(); ++k) {
    const c28x::Spent& s = noted.spent[k];
    if (s.cycles != 0) cycles[nb::int_(Profile::address(k))] = nb::make_tuple(s.cycles, s.registers, s.data, s.fetch);
  }
  nb::dict interrupts;
  for (const auto& [which, each] : noted.interrupts) interrupts[nb::make_tuple(which.first, which.second)] = each;
  return nb::make_tuple(cycles, interrupts, noted.highest_stack);
}

// By (vector, routine) and address: cycles.
nb::dict within(Self self) {
  nb::dict interrupts;
  for (const auto& [which, by_index] : profile(self).within) {
    nb::dict cycles;
    for (std::uint32_t k = 0; k < by_index.size(); ++k) {
      if (by_index[k] != 0) cycles[nb::int_(Profile::address(k))] = by_index[k];
    }
    interrupts[nb::make_tuple(which.first, which.second)] = cycles;
  }
  return interrupts;
}

// ---- for debuggers

using Named = std::vector<std::pair<std::string, std::uint32_t>>;

Named named(const Registers& r) {
  Named all = {{"ACC", r.acc}, {"P", r.p}, {"XT", r.xt}};
  for (std::size_t k = 0; k < r.xar.size(); ++k) all.emplace_back("XAR" + std::to_string(k), r.xar[k]);
  const Named rest = {{"PC", r.pc},     {"RPC", r.rpc}, {"SP", r.sp},   {"DP", r.dp},        {"ST0", r.st0()},
                      {"ST1", r.st1()}, {"IFR", r.ifr}, {"IER", r.ier}, {"DBGIER", r.dbgier}};
  all.insert(all.end(), rest.begin(), rest.end());
  return all;
}

nb::dict dict_of(const Registers& r) {
  nb::dict values;
  for (const auto& [name, value] : named(r)) values[name.c_str()] = value;
  return values;
}

void set_register(Self self, const std::string& name, std::uint32_t value) {
  c28x::Core& core = self.board().code();
  Registers& r = core.r;
  const std::uint16_t half = c28x::low_half(value);
  const std::map<std::string, std::uint32_t*> wide = {{"ACC", &r.acc}, {"P", &r.p}, {"XT", &r.xt}};
  const std::map<std::string, std::uint16_t*> narrow = {
      {"SP", &r.sp}, {"DP", &r.dp}, {"IFR", &r.ifr}, {"IER", &r.ier}, {"DBGIER", &r.dbgier}};
  if (const auto it = wide.find(name); it != wide.end()) {
    *it->second = value;
  } else if (const auto found = narrow.find(name); found != narrow.end()) {
    *found->second = half;
  } else if (name.size() == 4 && name.rfind("XAR", 0) == 0 && name[3] >= '0' && name[3] <= '7') {
    r.xar[static_cast<std::size_t>(name[3] - '0')] = value;
  } else if (name == "PC") {
    core.jump(value);
  } else if (name == "RPC") {
    r.rpc = value & c28x::kProgramMask;
  } else if (name == "ST0") {
    r.set_st0(half);
  } else if (name == "ST1") {
    r.set_st1(half);
  } else {
    throw std::invalid_argument("the core has no register '" + name + "'");
  }
}

void stop_at(Self self, const std::vector<std::uint32_t>& addresses, bool traps,
             const std::vector<std::pair<std::uint32_t, std::uint8_t>>& words) {
  c28x::Core& core = self.board().code();
  core.stop_nowhere();
  core.set_stop_at_breakpoint(traps);
  core.set_stop_at_illegal(traps);
  for (const std::uint32_t address : addresses) core.watch().stop_at(address, true);
  for (const auto& [address, kinds] : words) core.stop_on(address, kinds);
}

nb::list traced(Self self) {
  nb::list rows;
  for (const auto& row : self.board().code().watch().traced()) {
    rows.append(nb::make_tuple(row.cycles, dict_of(row.registers)));
  }
  return rows;
}

std::vector<std::uint16_t> words(Self self, std::uint32_t address, std::uint32_t count) {
  VirtualBoard& board = self.board();
  std::vector<std::uint16_t> all;
  for (std::uint32_t k = 0; k < count; ++k) all.push_back(board.inspect((address + k) & c28x::kProgramMask));
  return all;
}

using Change = std::tuple<std::uint64_t, std::uint64_t, std::int64_t>;

void record(Self self, std::vector<std::uint16_t> given, const std::vector<std::vector<Change>>& inputs) {
  chip::Recording& recording = self.board().recording();
  if (inputs.size() > recording.inputs.size()) throw std::invalid_argument("a recording does not have so many inputs");
  recording.given = std::move(given);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    std::vector<chip::RecordedInput::Change> changes;
    for (const auto& [samples, looks, value] : inputs[k]) changes.push_back({samples, looks, value});
    recording.inputs[k].give(std::move(changes));
  }
}

// Codes of the converter, writes to the ePWM as (samples before it, address, value, address behind its instruction),
// and of each other input its changes.
nb::tuple recorded(Self self) {
  const chip::Recording& recording = self.board().recording();
  nb::list writes;
  for (const auto& write : recording.writes) {
    writes.append(nb::make_tuple(write.samples, write.address, write.value, write.program));
  }
  nb::list inputs;
  for (const chip::RecordedInput& input : recording.inputs) {
    std::vector<Change> changes;
    for (const auto& change : input.changes()) changes.emplace_back(change.samples, change.looks, change.value);
    inputs.append(changes);
  }
  return nb::make_tuple(recording.samples, writes, inputs);
}

void replace_flash_library(Self self, std::uint32_t erase, std::uint32_t program, std::uint32_t verify,
                           std::uint32_t scale) {
  self.board().executing().replace_flash_library({erase, program, verify, scale});
}

// By address: reads, writes, and of the first of them the instruction and the cycle.
nb::dict dict_of(const chip::Uses& some) {
  nb::dict found;
  for (const auto& [address, use] : some.uses()) {
    found[nb::int_(address)] = nb::make_tuple(use.reads, use.writes, use.first.place, use.first.cycle);
  }
  return found;
}

}  // namespace

void bind_code(nb::class_<PythonBoard>& board) {
  board.def("code", &code)
      .def("profile", [](Self self) { self.board().code().take_profile(); })
      .def("spent", &spent)
      .def("within", &within)
      .def("registers", [](Self self) { return dict_of(self.board().code().r); })
      .def("set_register", &set_register, nb::arg("name"), nb::arg("value"))
      .def("stop_at", &stop_at, nb::arg("addresses"), nb::arg("traps") = false,
           nb::arg("words") = std::vector<std::pair<std::uint32_t, std::uint8_t>>{})
      .def(
          "stop_after",
          [](Self self, std::uint64_t instructions) { self.board().code().watch().stop_after(instructions); },
          nb::arg("instructions"))
      .def_prop_ro("accessed",
                   [](Self self) -> std::optional<std::pair<std::uint32_t, std::uint8_t>> {
                     const c28x::Watch::Access& access = self.board().code().watch().accessed();
                     if (access.address == c28x::Watch::kNowhere) return std::nullopt;
                     return std::make_pair(access.address, access.kinds);
                   })
      .def_prop_ro("halted", [](Self self) { return self.board().code().watch().halted; })
      .def(
          "trace", [](Self self, std::size_t depth) { self.board().code().watch().trace(depth); }, nb::arg("depth"))
      .def("traced", &traced)
      .def("words", &words, nb::arg("address"), nb::arg("count"))
      .def(
          "put", [](Self self, const chip::CodeBlocks& blocks) { self.board().executing().load(blocks); },
          nb::arg("blocks"))
      .def(
          "raise_interrupt", [](Self self, unsigned vector) { self.board().executing().raise_interrupt(vector); },
          nb::arg("vector"))
      .def("record", &record, nb::arg("given"), nb::arg("inputs") = std::vector<std::vector<Change>>())
      .def("recorded", &recorded)
      .def(
          "load_rom", [](Self self, const chip::CodeBlocks& blocks) { self.board().executing().load_rom(blocks); },
          nb::arg("blocks"))
      .def("unmodelled", [](Self self) { return dict_of(self.board().executing().in_vain().unmodelled); })
      .def("unallowed", [](Self self) { return dict_of(self.board().executing().in_vain().unallowed); })
      .def("unclocked", [](Self self) { return dict_of(self.board().executing().in_vain().unclocked); })
      .def("replace_flash_library", &replace_flash_library, nb::arg("erase"), nb::arg("program"), nb::arg("verify"),
           nb::arg("scale"));
}

}  // namespace stillspin::bench

// The class VirtualBoard of the Python module; core.py has the contract.

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include <memory>
#include <stdexcept>

#include "sim_host/bench/module_setup.hpp"
#include "sim_host/bench/virtual_board.hpp"

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

// Python decides when an object goes; the board goes with close().
struct PythonBoard {
  std::unique_ptr<VirtualBoard> held;

  VirtualBoard& board() const {
    if (!held) throw std::runtime_error("the virtual board has been closed");
    return *held;
  }
};

void construct(PythonBoard* self, const nb::dict& plant, const std::string& motor,
               const std::map<std::string, double>& parameters, std::uint64_t seed) {
  check_motor(motor);
  BoardRequest request;
  request.setup = setup_from(plant, seed);
  request.parameters = parameters;
  new (self) PythonBoard{std::make_unique<VirtualBoard>(request)};
}

void advance(const PythonBoard& self, Tick ticks) {
  VirtualBoard& board = self.board();
  const nb::gil_scoped_release release;
  board.advance(ticks);
}

void serial_write(const PythonBoard& self, const nb::bytes& octets) {
  const auto* const first = static_cast<const std::uint8_t*>(octets.data());
  self.board().serial().send(std::vector<std::uint8_t>(first, first + octets.size()), self.board().now());
}

nb::bytes serial_read(const PythonBoard& self) {
  const std::vector<std::uint8_t> octets = self.board().serial().take();
  return nb::bytes(octets.data(), octets.size());
}

Tick serial_pending(const PythonBoard& self) {
  VirtualBoard& board = self.board();
  return board.serial().sent_until(board.now()) - board.now();
}

nb::dict serial_counts(const PythonBoard& self) {
  const devices::SerialLine& line = self.board().serial();
  nb::dict counts;
  counts["sent"] = line.counts().sent;
  counts["received"] = line.counts().received;
  counts["framing_errors"] = line.counts().framing_errors;
  counts["drive_rate"] = line.chip_rate();
  return counts;
}

nb::dict dict_of(const std::vector<Quantity>& quantities) {
  nb::dict values;
  for (const Quantity& q : quantities) values[q.name] = q.value;
  return values;
}

nb::dict statistics(const PythonBoard& self) {
  const chip::Statistics s = self.board().statistics();
  nb::dict values;
  values["interrupts"] = s.interrupts;
  values["resets"] = s.resets;
  values["trips"] = self.board().trips();
  values["lost_writes"] = s.protected_writes_lost + s.gated_accesses;
  values["unmodelled_accesses"] = s.unmodelled_accesses;
  values["idle_ticks"] = s.idle_ticks;
  return values;
}

}  // namespace

void bind_virtual_board(nb::module_& m) {
  using Self = const PythonBoard&;
  nb::class_<PythonBoard>(m, "VirtualBoard")
      .def("__init__", &construct, nb::kw_only(), nb::arg("plant"), nb::arg("motor"), nb::arg("parameters"),
           nb::arg("seed"), "Power the board; see core.py.")
      .def("close", [](PythonBoard& self) { self.held.reset(); })
      .def("advance", &advance, nb::arg("ticks"))
      .def_prop_ro("now", [](Self self) { return self.board().now(); })
      .def("serial_write", &serial_write, nb::arg("octets"))
      .def("serial_read", &serial_read)
      .def(
          "serial_break", [](Self self, double bits) { self.board().serial().send_break(bits, self.board().now()); },
          nb::arg("bits"))
      .def(
          "serial_noise",
          [](Self self, double flips, std::uint64_t seed) { self.board().serial().set_noise(flips, seed); },
          nb::arg("flips_per_bit"), nb::arg("seed"))
      .def_prop_rw(
          "serial_rate", [](Self self) { return self.board().serial().rate(); },
          [](Self self, double rate) { self.board().serial().set_rate(rate); })
      .def_prop_ro("serial_pending", &serial_pending)
      .def("serial_counts", &serial_counts)
      .def(
          "set_load", [](Self self, double torque) { self.board().set_load(torque); }, nb::arg("torque"))
      .def("truth", [](Self self) { return dict_of(self.board().truth()); })
      .def("signals", [](Self self) { return (void)self.board(), dict_of(VirtualBoard::signals()); })
      .def("statistics", &statistics);
}

}  // namespace stillspin::bench

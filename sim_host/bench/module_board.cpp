// The class VirtualBoard of the Python module; core.py has the contract.

#include "sim_host/bench/module_board.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "sim_host/bench/loop_plugs.hpp"
#include "sim_host/bench/module_setup.hpp"

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

void construct(PythonBoard* self, const nb::dict& plant, const std::map<std::string, double>& parameters,
               std::uint64_t seed, const chip::CodeBlocks& image) {
  BoardRequest request;
  request.setup = setup_from(plant, seed);
  request.parameters = parameters;
  request.image = image;
  new (self) PythonBoard{std::make_unique<VirtualBoard>(request)};
}

void advance(const PythonBoard& self, Tick ticks) {
  VirtualBoard& board = self.board();
  const nb::gil_scoped_release release;
  board.advance(ticks);
}

bool advance_until_heard(const PythonBoard& self, Tick ticks) {
  VirtualBoard& board = self.board();
  const nb::gil_scoped_release release;
  return board.advance_until_heard(ticks);
}

// Of a board in the loop, as bytes and numbers: see LoopPlugs.
nb::tuple serve_loop(const PythonBoard& self, int serial, int can, int milliseconds) {
  VirtualBoard& board = self.board();
  LoopPlugs::Served s;
  {
    const nb::gil_scoped_release release;
    s = LoopPlugs(board, serial, can).serve(milliseconds);
  }
  const auto bytes = [](const LoopPlugs::Octets& octets) { return nb::bytes(octets.data(), octets.size()); };
  return nb::make_tuple(s.serial_in, s.serial_out, bytes(s.for_adapter), bytes(s.serial_left), bytes(s.can_left));
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

// ---- the other node on the CAN bus: a frame is (identifier, extended, remote, length, data)

using PythonFrame = std::tuple<std::uint32_t, bool, bool, unsigned, nb::bytes>;

chip::CanFrame frame_from(const PythonFrame& given) {
  const auto& [id, extended, remote, length, data] = given;
  if (id > (extended ? 0x1FFFFFFFu : 0x7FFu) || length > 8 || data.size() > length) {
    throw std::invalid_argument("a CAN frame has an identifier of 11 or 29 bits and up to 8 octets");
  }
  chip::CanFrame frame;
  frame.id = id;
  frame.extended = extended;
  frame.remote = remote;
  frame.length = static_cast<std::uint8_t>(length);
  const auto* const first = static_cast<const std::uint8_t*>(data.data());
  std::copy(first, first + data.size(), frame.data.begin());
  return frame;
}

void can_write(const PythonBoard& self, const PythonFrame& frame) {
  self.board().can_host().send(frame_from(frame), self.board().now());
}

nb::list can_read(const PythonBoard& self) {
  nb::list frames;
  for (const auto& heard : self.board().can_host().take_heard(self.board().now())) {
    const chip::CanFrame& f = heard.frame;
    const std::size_t octets = f.remote ? 0 : f.length;
    const nb::bytes data(reinterpret_cast<const char*>(f.data.data()), octets);
    frames.append(nb::make_tuple(heard.t, f.id, f.extended, f.remote, static_cast<unsigned>(f.length), data));
  }
  return frames;
}

void can_open(const PythonBoard& self, std::uint32_t rate, bool listen_only) {
  if (rate > 1'000'000) throw std::invalid_argument("a CAN bus has at most 1 Mbit/s");
  self.board().can_host().set_listening_only(listen_only);
  self.board().can_host().set_bit_rate(rate, self.board().now());
}

void can_flood(const PythonBoard& self, const std::optional<PythonFrame>& frame) {
  VirtualBoard& board = self.board();
  if (frame) {
    board.can_host().flood(frame_from(*frame), board.now());
  } else {
    board.can_host().stop_flood(board.now());
  }
}

void can_plug(const PythonBoard& self, bool plugged) {
  VirtualBoard& board = self.board();
  board.can_bus().set_plugged(board.can_host(), plugged, board.now());
}

nb::dict can_counts(const PythonBoard& self) {
  const devices::CanHost& host = self.board().can_host();
  const devices::CanBus& bus = self.board().can_bus();
  nb::dict counts;
  counts["sent"] = host.sent();
  counts["waiting"] = host.waiting();
  counts["transmit_errors"] = host.errors().transmit();
  counts["receive_errors"] = host.errors().receive();
  counts["bus_offs"] = host.bus_offs();
  counts["frames"] = bus.frames();
  counts["broken_frames"] = bus.broken_frames();
  counts["busy_ticks"] = bus.busy_ticks();
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
  const Board& pins = self.board().pins();
  values["gate_edges"] = pins.gate_edges();
  values["enable_earliest"] = pins.enable_earliest();
  values["enable_latest"] = pins.enable_latest();
  values["lost_writes"] = s.protected_writes_lost + s.gated_accesses;
  values["unmodelled_accesses"] = s.unmodelled_accesses;
  values["idle_ticks"] = s.idle_ticks;
  return values;
}

}  // namespace

void bind_virtual_board(nb::module_& m) {
  using Self = const PythonBoard&;
  nb::class_<PythonBoard> board(m, "VirtualBoard");
  board
      .def("__init__", &construct, nb::kw_only(), nb::arg("plant"), nb::arg("parameters"), nb::arg("seed"),
           nb::arg("image") = chip::CodeBlocks(), "Power the board; see core.py.")
      .def("close", [](PythonBoard& self) { self.held.reset(); })
      .def("advance", &advance, nb::arg("ticks"))
      .def("advance_until_heard", &advance_until_heard, nb::arg("ticks"))
      .def("serve_loop", &serve_loop, nb::arg("serial"), nb::arg("can"), nb::arg("milliseconds"))
      .def_prop_ro("in_loop", [](Self self) { return (void)self.board(), VirtualBoard::in_loop(); })
      .def_prop_ro("can_waiting", [](Self self) { return self.board().can_host().waiting(); })
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
      .def_prop_rw(
          "eeprom",
          [](Self self) {
            const auto& octets = self.board().eeprom();
            return nb::bytes(octets.data(), octets.size());
          },
          [](Self self, nb::bytes octets) {
            const auto* const first = static_cast<const std::uint8_t*>(octets.data());
            self.board().set_eeprom({first, first + octets.size()});
          })
      .def_prop_ro("serial_pending", &serial_pending)
      .def("serial_counts", &serial_counts)
      .def("can_open", &can_open, nb::arg("rate"), nb::arg("listen_only") = false)
      .def("can_write", &can_write, nb::arg("frame"))
      .def("can_read", &can_read)
      .def("can_counts", &can_counts)
      .def("can_flood", &can_flood, nb::arg("frame").none())
      .def("can_plug", &can_plug, nb::arg("plugged"))
      .def(
          "set_load", [](Self self, double torque) { self.board().set_load(torque); }, nb::arg("torque"))
      .def(
          "set_input", [](Self self, const std::string& name, double value) { self.board().set_input(name, value); },
          nb::arg("name"), nb::arg("value"))
      .def("outputs", [](Self self) { return dict_of(self.board().outputs()); })
      .def("begin_run", [](Self self) { self.board().begin_run(); })
      .def("truth", [](Self self) { return dict_of(self.board().truth()); })
      .def("signals", [](Self self) { return self.board().executes() ? nb::dict() : dict_of(VirtualBoard::signals()); })
      .def("statistics", &statistics)
      .def(
          "inspect", [](Self self, std::uint32_t address) { return self.board().inspect(address); },
          nb::arg("address"));
  bind_code(board);
}

}  // namespace stillspin::bench

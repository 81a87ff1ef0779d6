// The class LoaderBoard of the Python module; core_loader.py has the contract.

#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <stdexcept>

#include "sim_host/bench/loader_board.hpp"
#include "sim_host/bench/module_setup.hpp"

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

using Blocks = std::vector<std::pair<std::uint32_t, std::vector<std::uint16_t>>>;

// Python decides when an object goes; the board goes with close().
struct PythonLoader {
  std::unique_ptr<LoaderBoard> held;

  LoaderBoard& board() const {
    if (!held) throw std::runtime_error("the virtual board has been closed");
    return *held;
  }
};

void construct(PythonLoader* self, std::uint32_t entry, const Blocks& blocks) {
  new (self) PythonLoader{std::make_unique<LoaderBoard>(LoadedProgram{entry, blocks})};
}

void advance(const PythonLoader& self, Tick ticks) {
  LoaderBoard& board = self.board();
  const nb::gil_scoped_release release;
  board.advance(ticks);
}

bool advance_until_heard(const PythonLoader& self, Tick ticks) {
  LoaderBoard& board = self.board();
  const nb::gil_scoped_release release;
  return board.advance_until_heard(ticks);
}

void serial_write(const PythonLoader& self, const nb::bytes& octets) {
  const auto* const first = static_cast<const std::uint8_t*>(octets.data());
  self.board().serial().send(std::vector<std::uint8_t>(first, first + octets.size()), self.board().serial_now());
}

nb::bytes serial_read(const PythonLoader& self) {
  const std::vector<std::uint8_t> octets = self.board().serial().take();
  return nb::bytes(octets.data(), octets.size());
}

Tick serial_pending(const PythonLoader& self) {
  LoaderBoard& board = self.board();
  return board.serial().sent_until(board.serial_now()) - board.serial_now();
}

nb::dict serial_counts(const PythonLoader& self) {
  nb::dict counts;
  counts["received"] = self.board().serial().counts().received;
  counts["drive_rate"] = self.board().serial().chip_rate();
  return counts;
}

}  // namespace

void bind_loader_board(nb::module_& m) {
  using Self = const PythonLoader&;
  nb::class_<PythonLoader>(m, "LoaderBoard")
      .def("__init__", &construct, nb::kw_only(), nb::arg("entry"), nb::arg("blocks"))
      .def("close", [](PythonLoader& self) { self.held.reset(); })
      .def("advance", &advance, nb::arg("ticks"))
      .def("advance_until_heard", &advance_until_heard, nb::arg("ticks"))
      .def("power_cycle", [](Self self) { self.board().power_cycle(); })
      .def(
          "set_serial_boot",
          [](Self self, bool on) { self.board().set_jumpers(on ? BootMode::kSerial : BootMode::kFlash); },
          nb::arg("on"))
      .def_prop_ro("now", [](Self self) { return self.board().now(); })
      .def_prop_ro("running", [](Self self) { return std::string(words_of(self.board().running())); })
      .def_prop_ro("driven", [](Self self) { return self.board().driven(); })
      .def_prop_ro("in_loop", [](Self self) { return (void)self.board(), false; })
      .def_prop_rw(
          "flash", [](Self self) { return self.board().flash(); },
          [](Self self, std::vector<std::uint16_t> words) { self.board().set_flash(std::move(words)); })
      .def("serial_write", &serial_write, nb::arg("octets"))
      .def("serial_read", &serial_read)
      .def_prop_rw(
          "serial_rate", [](Self self) { return self.board().serial().rate(); },
          [](Self self, double rate) { self.board().serial().set_rate(rate); })
      .def_prop_ro("serial_pending", &serial_pending)
      .def("serial_counts", &serial_counts);
}

}  // namespace stillspin::bench

// The class StepLoop of the Python module: a board in the loop; core_loop.py has the contract.

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <utility>

#include "sim_host/bench/board_port.hpp"
#include "sim_host/bench/module_setup.hpp"
#include "sim_host/bench/step_loop.hpp"

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

struct PythonLoop {
  std::shared_ptr<StepLoop> loop;
};

nb::bytes bytes_of(const Octets& octets) { return nb::bytes(octets.data(), octets.size()); }

std::unique_ptr<Way> way_through(int descriptor, unsigned node) {
  return std::make_unique<BoardPort>(descriptor, node > 0 ? slcan_framing(node) : serial_framing());
}

// A function that takes a request and gives its answer.
class PythonWay final : public Way {
 public:
  explicit PythonWay(nb::object ask) : ask_(std::move(ask)) {}

  void send(const Octets& request) override {
    const nb::gil_scoped_acquire gil;
    try {
      const auto answer = nb::cast<nb::bytes>(ask_(bytes_of(request)));
      const auto* const first = static_cast<const std::uint8_t*>(answer.data());
      answer_.assign(first, first + answer.size());
    } catch (const nb::python_error& error) {
      throw PortError(error.what());
    }
  }

  Octets receive() override { return answer_; }

 private:
  nb::object ask_;
  Octets answer_;
};

nb::object mismatch_of(const StepLoop& loop) {
  if (!loop.mismatch()) return nb::none();
  const Mismatch& m = *loop.mismatch();
  return nb::make_tuple(m.step, m.torn, m.board, m.native, m.signals);
}

nb::object refusal_of(const StepLoop& loop) {
  if (!loop.refusal()) return nb::none();
  return nb::make_tuple(loop.refusal()->status, nb::bytes(loop.refusal()->words.data(), loop.refusal()->words.size()));
}

}  // namespace

RecordingSink recording_sink_of(const nb::object& loop) {
  if (loop.is_none()) return {};
  const std::shared_ptr<StepLoop> taker = nb::cast<const PythonLoop&>(loop).loop;
  return [taker](const RecordedPeriod& period) { return taker->take(period); };
}

void bind_step_loop(nb::module_& m) {
  using Self = const PythonLoop&;
  nb::class_<PythonLoop>(m, "StepLoop")
      .def_static(
          "through",
          [](int fd, unsigned node) { return PythonLoop{std::make_shared<StepLoop>(way_through(fd, node))}; },
          nb::arg("descriptor"), nb::arg("node"))
      .def_static(
          "asking",
          [](const nb::object& ask) {
            return PythonLoop{std::make_shared<StepLoop>(std::make_unique<PythonWay>(ask))};
          },
          nb::arg("ask"))
      .def_prop_ro("steps", [](Self self) { return self.loop->steps(); })
      .def_prop_ro("mismatch", [](Self self) { return mismatch_of(*self.loop); })
      .def_prop_ro("refusal", [](Self self) { return refusal_of(*self.loop); })
      .def_prop_ro("lost", [](Self self) { return self.loop->lost(); })
      .def("finish",
           [](Self self) {
             const nb::gil_scoped_release release;
             self.loop->finish();
           })
      .def("take_logs", [](Self self) {
        const auto [board, native] = self.loop->take_logs();
        return nb::make_tuple(bytes_of(board), bytes_of(native));
      });
}

}  // namespace stillspin::bench

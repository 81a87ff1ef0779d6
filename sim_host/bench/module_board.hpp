// The board as Python holds it, shared by the parts of the module.

#ifndef STILLSPIN_SIM_HOST_BENCH_MODULE_BOARD_HPP
#define STILLSPIN_SIM_HOST_BENCH_MODULE_BOARD_HPP

#include <nanobind/nanobind.h>

#include <memory>
#include <stdexcept>

#include "sim_host/bench/virtual_board.hpp"

namespace stillspin::bench {

// Python decides when an object goes; the board goes with close().
struct PythonBoard {
  std::unique_ptr<VirtualBoard> held;

  VirtualBoard& board() const {
    if (!held) throw std::runtime_error("the virtual board has been closed");
    return *held;
  }
};

/// What a board that executes an image has beside the others.
void bind_code(nanobind::class_<PythonBoard>& board);

}  // namespace stillspin::bench

#endif

// What the parts of the Python module share: a plant from Python's nested dicts.

#ifndef STILLSPIN_SIM_HOST_BENCH_MODULE_SETUP_HPP
#define STILLSPIN_SIM_HOST_BENCH_MODULE_SETUP_HPP

#include <nanobind/nanobind.h>

#include <cstdint>
#include <string>

#include "sim_host/bench/recording_tap.hpp"
#include "sim_host/bench/setup.hpp"

namespace stillspin::bench {

/// Section -> key -> number, switch or word, and the noise's seed; std::invalid_argument for what does not exist.
Setup setup_from(const nanobind::dict& plant, std::uint64_t seed);

/// What a table of a machine's flux says at zero current.
void bind_flux_map(nanobind::module_& module);

/// The class VirtualBoard.
void bind_virtual_board(nanobind::module_& module);

/// The class StepLoop.
void bind_step_loop(nanobind::module_& module);

/// The taker of a recording that Python means: a StepLoop, or None for no recording.
RecordingSink recording_sink_of(const nanobind::object& loop);

/// The class LoaderBoard.
void bind_loader_board(nanobind::module_& module);

/// The messages of the drive's CAN bus: table, packing and unpacking.
void bind_can_messages(nanobind::module_& module);

}  // namespace stillspin::bench

#endif

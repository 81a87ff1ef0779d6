// Frames as lines of the LAWICEL ASCII protocol (sim_host/stillspin/board/slcan.py), where it has to be quick.

#ifndef STILLSPIN_SIM_HOST_BENCH_SLCAN_LINE_HPP
#define STILLSPIN_SIM_HOST_BENCH_SLCAN_LINE_HPP

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "sim_host/chip/can_line.hpp"

namespace stillspin::bench {

/// Appends the line of a frame with its carriage return.
void put_slcan_line(std::vector<std::uint8_t>& octets, const chip::CanFrame& frame);

/// The data frame with 11 bits of identifier that a line without its carriage return begins with; every other line is
/// none. `rest`: what stands behind its data, such as a time stamp.
std::optional<chip::CanFrame> slcan_frame(std::string_view line, std::string_view& rest);

}  // namespace stillspin::bench

#endif

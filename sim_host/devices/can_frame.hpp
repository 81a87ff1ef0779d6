// A CAN frame on the wire: how many bits it has, and who wins against whom.
//
// The bits are those of ISO 11898-1: start, arbitration, control and data fields and CRC-15 with a stuff bit after five
// equal ones, then CRC delimiter, acknowledge slot and delimiter and seven bits end of frame.

#ifndef STILLSPIN_SIM_HOST_DEVICES_CAN_FRAME_HPP
#define STILLSPIN_SIM_HOST_DEVICES_CAN_FRAME_HPP

#include <cstdint>

#include "sim_host/chip/can_line.hpp"

namespace stillspin::devices {

/// Bits behind the stuffed part.
inline constexpr int kCanTailBits = 10;         // CRC delimiter, acknowledge slot and delimiter, end of frame
inline constexpr int kCanIntermissionBits = 3;  // before the next start
inline constexpr int kCanErrorFlagBits = 6;
inline constexpr int kCanErrorDelimiterBits = 8;
inline constexpr int kCanSuspendBits = 8;  // a passive node waits after having sent

/// From the start bit to the end of frame, stuff bits included: 47 to 135 for standard, to 160 for extended frames.
int can_frame_bits(const chip::CanFrame& frame);

/// The arbitration field as a number: the smaller wins.
std::uint32_t can_arbitration_key(const chip::CanFrame& frame);

}  // namespace stillspin::devices

#endif

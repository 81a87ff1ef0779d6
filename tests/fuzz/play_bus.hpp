// Plays any frames on the CAN bus to a drive and judges what becomes of it.
//
// The input is a row of steps, each begun by an octet:
//   0..2 modulo 8   a frame of the group command, parameter, record: the next octet's lower half is its length (0..8),
//                   then its data
//   3               the next octet's ms pass
//   4               a command with the right length, CRC and alive counter: mode, speed and flags by the next 3 octets
//   5               the next n octets (n modulo 64) are a record, sent in pieces with its CRC
//   6               the drive is put into the state that the next octet names
//   7               state of the bus, a sender that is stuck, and a fault, by the next octet
//
// What carries the commands out is the drive itself (fuzz_drive.h).

#ifndef STILLSPIN_TESTS_FUZZ_PLAY_BUS_HPP
#define STILLSPIN_TESTS_FUZZ_PLAY_BUS_HPP

#include <cstddef>
#include <cstdint>
#include <string>

namespace stillspin::test {

/// What is wrong: a parameter out of its range, or a drive that cannot be stopped or asked afterwards. Empty when all
/// is well.
std::string play_bus(const std::uint8_t* octets, std::size_t count);

}  // namespace stillspin::test

#endif

// Plays any octets to the serial port of a drive and judges what becomes of it.
//
// Octets go to the port as they are; three have another meaning so that a search gets behind what random octets hardly
// pass:
//   0xFD n   the next n octets (n modulo 64) are a record: they are sent with the right CRC and COBS
//   0xFE n   n ms pass
//   0xFC n   something happens to the drive: a fault, a state, an error of the port, a turn of the encoder, by n
//
// What carries the commands out is the drive itself (fuzz_drive.h).

#ifndef STILLSPIN_TESTS_FUZZ_PLAY_HPP
#define STILLSPIN_TESTS_FUZZ_PLAY_HPP

#include <cstddef>
#include <cstdint>
#include <string>

namespace stillspin::test {

/// What is wrong: a record that cannot be read, a text that is none, a parameter out of its range, or a drive that
/// cannot be stopped or asked afterwards. Empty when all is well.
std::string play(const std::uint8_t* octets, std::size_t count);

}  // namespace stillspin::test

#endif

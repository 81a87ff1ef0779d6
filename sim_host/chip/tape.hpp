// What the converter saw and what the program made of it: recorded in one run, given to another, compared.

#ifndef STILLSPIN_SIM_HOST_CHIP_TAPE_HPP
#define STILLSPIN_SIM_HOST_CHIP_TAPE_HPP

#include <cstdint>
#include <vector>

namespace stillspin::chip {

struct Tape {
  /// A write to a register of the ePWM modules.
  struct Write {
    std::uint64_t samples;  // that the converter had taken by then
    std::uint32_t address;
    std::uint16_t value;
    std::uint32_t program;  // the address behind the instruction; 0 where the firmware is no code of the C28x
  };

  /// Codes of the converter in the order of its samples.
  std::vector<std::uint16_t> samples;
  std::vector<Write> writes;

  /// Codes that the converter is given instead of what it sees, as long as there are some.
  std::vector<std::uint16_t> given;

  std::uint16_t sample(std::uint16_t seen) {
    const std::uint16_t code = samples.size() < given.size() ? given[samples.size()] : seen;
    samples.push_back(code);
    return code;
  }
  void write(std::uint32_t address, std::uint16_t value, std::uint32_t program) {
    writes.push_back({samples.size(), address, value, program});
  }
};

}  // namespace stillspin::chip

#endif

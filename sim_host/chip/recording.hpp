// What the chip was told from outside and what the program made of it: recorded in one run, given to another, compared.
//
// A step is a sample of the converter. Of the levels of pins, the trip inputs and the encoder the changes are noted,
// each with its step and how often the input had been looked at in that step before: another run that looks in the same
// order sees the same, whatever its time is. Octets of the serial line are not here: they are sent at a time.

#ifndef STILLSPIN_SIM_HOST_CHIP_RECORDING_HPP
#define STILLSPIN_SIM_HOST_CHIP_RECORDING_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace stillspin::chip {

/// One input beside the converter.
class RecordedInput {
 public:
  struct Change {
    std::uint64_t samples;  // that the converter had taken by then
    std::uint64_t looks;    // in that step before
    std::int64_t value;
  };

  /// Values that are seen from now on instead of the real ones, unless there are none.
  void give(std::vector<Change> given) { given_ = std::move(given); }

  /// What is seen in a look, and noted.
  std::int64_t look(std::uint64_t samples, std::int64_t seen) {
    if (samples != step_) looks_ = 0;
    step_ = samples;
    const std::int64_t value = given_.empty() ? seen : played();
    if (changes_.empty() || changes_.back().value != value) changes_.push_back({samples, looks_, value});
    ++looks_;
    return value;
  }
  const std::vector<Change>& changes() const { return changes_; }

 private:
  std::int64_t played() {
    while (next_ + 1 < given_.size() && is_due(given_[next_ + 1])) ++next_;
    return given_[next_].value;
  }
  bool is_due(const Change& c) const { return c.samples < step_ || (c.samples == step_ && c.looks <= looks_); }

  std::vector<Change> changes_, given_;
  std::size_t next_ = 0;
  std::uint64_t step_ = 0, looks_ = 0;
};

struct Recording {
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

  /// Levels of pins 0 to 15, 16 to 31 and 32 to 34 as the program reads them, trip inputs that are active, edges of the
  /// encoder.
  enum Input { kPins, kTrips = kPins + 3, kEncoder, kInputs };
  std::array<RecordedInput, kInputs> inputs;

  std::uint16_t sample(std::uint16_t seen) {
    const std::uint16_t code = samples.size() < given.size() ? given[samples.size()] : seen;
    samples.push_back(code);
    return code;
  }
  void write(std::uint32_t address, std::uint16_t value, std::uint32_t program) {
    writes.push_back({samples.size(), address, value, program});
  }
  std::int64_t look(unsigned input, std::int64_t seen) { return inputs[input].look(samples.size(), seen); }
};

}  // namespace stillspin::chip

#endif

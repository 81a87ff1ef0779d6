// The FIFO of a serial port's transmitter or receiver: 16 words.

#ifndef STILLSPIN_SIM_HOST_CHIP_SCI_FIFO_HPP
#define STILLSPIN_SIM_HOST_CHIP_SCI_FIFO_HPP

#include <array>
#include <cstdint>

namespace stillspin::chip {

class SciFifo {
 public:
  static constexpr unsigned kDepth = 16;

  void clear() { first_ = count_ = 0; }
  unsigned count() const { return count_; }
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == kDepth; }

  /// The oldest word; when empty, what was read last.
  std::uint16_t front() const { return words_[first_]; }

  std::uint16_t pop() {
    const std::uint16_t word = words_[first_];
    if (!empty()) {
      first_ = (first_ + 1) % kDepth;
      --count_;
      if (empty()) words_[first_] = word;
    }
    return word;
  }

  /// The FIFO must not be full.
  void push(std::uint16_t word) { words_[(first_ + count_++) % kDepth] = word; }

 private:
  std::array<std::uint16_t, kDepth> words_{};
  unsigned first_ = 0;
  unsigned count_ = 0;
};

}  // namespace stillspin::chip

#endif

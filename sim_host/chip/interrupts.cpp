#include "sim_host/chip/interrupts.hpp"

namespace stillspin::chip {
namespace {

constexpr unsigned kChannels = 8;
constexpr std::uint16_t kGroupMask = 0x0FFF;  // PIEACK has a bit for each group
constexpr std::uint16_t kChannelMask = 0x00FF;
constexpr unsigned kInt13Line = 12;  // IFR/IER bit
constexpr unsigned kInt14Line = 13;
constexpr std::uint32_t kTableAddress = 0x0D00;  // of the vectors, two words each: what PIECTRL.PIEVECT shows

// Index of the lowest bit that is set; `bits` is not 0.
unsigned lowest(unsigned bits) { return static_cast<unsigned>(__builtin_ctz(bits)); }

}  // namespace

bool Interrupts::raise(unsigned vector) {
  if (vector >= VECTOR_PIE_FIRST && vector < VECTOR_COUNT) {
    const unsigned group = (vector - VECTOR_PIE_FIRST) / kChannels;
    flags_[group] = static_cast<std::uint16_t>(flags_[group] | 1u << vector % kChannels);
    offer(group);
    return true;
  }
  if (vector != kVectorInt13 && vector != VECTOR_TINT2) return false;
  ifr_ = static_cast<std::uint16_t>(ifr_ | 1u << (vector == kVectorInt13 ? kInt13Line : kInt14Line));
  return true;
}

unsigned Interrupts::fetch(unsigned line, bool& spurious) {
  unsigned vector = line + 1;  // INT13, INT14: vectors 13 and 14
  if (line < kGroups) {
    const unsigned ready = flags_[line] & enables_[line];
    spurious = ready == 0;
    const unsigned channel = spurious ? 0 : lowest(ready);
    flags_[line] = static_cast<std::uint16_t>(flags_[line] & ~(spurious ? 0u : 1u << channel));
    vector = VECTOR_PIE_FIRST + kChannels * line + channel;
  }
  const std::uint32_t address = kTableAddress + 2 * vector;
  ctrl_ = static_cast<std::uint16_t>((address & PIECTRL_PIEVECT_MASK) | (ctrl_ & PIECTRL_ENPIE_MASK));
  return vector;
}

Interrupts::Frame Interrupts::enter() {
  Frame frame;
  frame.ier = ier_;
  const unsigned line = lowest(static_cast<unsigned>(ifr_ & ier_));
  frame.vector = fetch(line, frame.spurious);
  ifr_ = static_cast<std::uint16_t>(ifr_ & ~(1u << line));
  ier_ = static_cast<std::uint16_t>(ier_ & ~(1u << line));
  masked_ = true;
  return frame;
}

void Interrupts::leave(const Frame& frame) {
  ier_ = frame.ier;
  masked_ = false;  // it was clear, or the interrupt had not been taken
}

std::uint16_t Interrupts::read(std::uint16_t offset) const {
  if (offset == 0) return ctrl_;
  if (offset == 1) return acknowledge_;
  const unsigned group = (offset - 2u) / 2u;
  if (group >= kGroups) return 0;
  return offset % 2 == 0 ? enables_[group] : flags_[group];
}

void Interrupts::write(std::uint16_t offset, std::uint16_t value) {
  if (offset == 0) {
    ctrl_ = static_cast<std::uint16_t>((ctrl_ & PIECTRL_PIEVECT_MASK) | (value & PIECTRL_ENPIE_MASK));
    return;
  }
  if (offset == 1) {
    acknowledge_ = static_cast<std::uint16_t>(acknowledge_ & ~value);
    for (unsigned waiting = value & kGroupMask; waiting != 0; waiting &= waiting - 1) offer(lowest(waiting));
    return;
  }
  const unsigned group = (offset - 2u) / 2u;
  if (group >= kGroups) return;
  auto& target = offset % 2 == 0 ? enables_ : flags_;
  target[group] = static_cast<std::uint16_t>(value & kChannelMask);
  offer(group);
}

}  // namespace stillspin::chip

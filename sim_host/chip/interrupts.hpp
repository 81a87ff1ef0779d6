// The way of an interrupt: PIE flag -> PIE enable -> group acknowledge -> IFR -> IER -> INTM, and the vector table.
//
// Twelve PIE groups of eight channels feed the CPU lines INT1..INT12 (bits 0..11 of IFR and IER); CPU timers 1 and 2 go
// to INT13 and INT14 directly. A group that has sent a request is blocked until firmware writes its PIEACK bit,
// whatever else happens: an ISR that forgets it gets no second interrupt from its group. Source: SPRU712 (PIE), SPRU430
// (CPU).

#ifndef STILLSPIN_SIM_HOST_CHIP_INTERRUPTS_HPP
#define STILLSPIN_SIM_HOST_CHIP_INTERRUPTS_HPP

#include <array>
#include <cstdint>

#include "hal/f2808/registers.h"

namespace stillspin::chip {

using Isr = void (*)();

class Interrupts {
 public:
  static constexpr unsigned kGroups = 12;
  static constexpr unsigned kVectorInt13 = 13;  // CPU timer 1; CPU timer 2 is VECTOR_TINT2, INT14

  void reset() { *this = Interrupts{}; }

  /// A peripheral's pulse: latches the flag of a PIE channel or of INT13/INT14. False for a vector that is neither.
  bool raise(unsigned vector);

  bool deliverable() const { return !masked_ && !held_ && requested(); }
  bool requested() const { return (ifr_ & ier_) != 0; }

  /// What the CPU does at an interrupt entry: takes the highest-priority enabled request, clears its IFR and IER bits,
  /// sets INTM and fetches the vector number. What is to be restored at the return goes to `frame`.
  struct Frame {
    std::uint16_t ier = 0;
    unsigned vector = 0;
    bool spurious = false;  // the channel vanished between request and fetch: the hardware runs channel 1
  };
  Frame enter();
  void leave(const Frame& frame);

  /// The vector of a CPU line, 0 to 13, that the CPU has taken: of its first channel that is flagged and enabled, whose
  /// flag is cleared.
  unsigned fetch(unsigned line, bool& spurious);

  Isr vector(unsigned number) const { return vectors_[number]; }
  void set_vector(unsigned number, Isr isr) { vectors_[number] = isr; }
  bool table_enabled() const { return (ctrl_ & PIECTRL_ENPIE_MASK) != 0; }

  bool masked() const { return masked_; }
  void set_masked(bool masked) { masked_ = masked; }
  /// From outside, as if other code had masked them.
  void set_held(bool held) { held_ = held; }
  bool held() const { return held_; }
  std::uint16_t ier() const { return ier_; }
  void set_ier(std::uint16_t mask) { ier_ = mask; }
  std::uint16_t ifr() const { return ifr_; }
  void clear_ifr() { ifr_ = 0; }

  /// PIECTRL, PIEACK, PIEIER1.., PIEIFR1.. by word offset from REG_PIECTRL.
  std::uint16_t read(std::uint16_t offset) const;
  void write(std::uint16_t offset, std::uint16_t value);

 private:
  // Sends a group's request to the CPU when one is flagged, enabled and not blocked.
  void offer(unsigned group) {
    const auto bit = static_cast<std::uint16_t>(1u << group);
    if ((flags_[group] & enables_[group]) == 0 || (acknowledge_ & bit) != 0) return;
    acknowledge_ = static_cast<std::uint16_t>(acknowledge_ | bit);
    ifr_ = static_cast<std::uint16_t>(ifr_ | bit);
  }

  bool masked_ = true;  // INTM
  bool held_ = false;
  std::uint16_t ifr_ = 0;
  std::uint16_t ier_ = 0;
  std::uint16_t ctrl_ = 0;
  std::uint16_t acknowledge_ = 0;
  std::array<std::uint16_t, kGroups> enables_{};
  std::array<std::uint16_t, kGroups> flags_{};
  std::array<Isr, VECTOR_COUNT> vectors_{};
};

}  // namespace stillspin::chip

#endif

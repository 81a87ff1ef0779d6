// What a CAN controller and the bus it hangs on know of each other: whole frames, at their exact times.
//
// The bus decides who sends; a node says what it would send. Bits are not exchanged one by one, but their number is
// that of the real frame, stuff bits included. Times are ticks of 10 ns; every call's t is that of the present. Calls
// to a node may come inside of its own call to changed().

#ifndef STILLSPIN_SIM_HOST_CHIP_CAN_LINE_HPP
#define STILLSPIN_SIM_HOST_CHIP_CAN_LINE_HPP

#include <array>
#include <cstdint>

namespace stillspin::chip {

struct CanFrame {
  std::uint32_t id = 0;  // 11 or 29 bits
  bool extended = false;
  bool remote = false;
  std::uint8_t length = 0;  // 0..8; of a remote frame the length asked for
  std::array<std::uint8_t, 8> data{};

  bool operator==(const CanFrame& o) const {
    return id == o.id && extended == o.extended && remote == o.remote && length == o.length && data == o.data;
  }
};

/// kForm: a receiver that found the frame wrong before anybody else, so that the others' flags follow its own.
enum class CanError { kAcknowledge, kBit, kStuff, kForm };

/// A controller, as the bus sees it.
class CanNode {
 public:
  /// Length of its bits in ticks; 0 while it takes no part (off, being configured, bus-off, not yet synchronised).
  virtual std::int64_t can_bit_time() const = 0;
  /// The frame it wants to send next, nullptr for none. Valid until the next call to this node.
  virtual const CanFrame* can_offer() = 0;
  virtual bool can_error_passive() const = 0;
  /// False for a node that only listens: it neither acknowledges nor marks errors.
  virtual bool can_acknowledges() const = 0;

  /// A dominant bit appears on the line; `mine`: the start of the frame that was offered, which is being sent now.
  virtual void can_busy(std::int64_t t, bool mine) = 0;
  /// The line has been recessive since `since`, which is not after t.
  virtual void can_quiet(std::int64_t since, std::int64_t t) = 0;
  virtual void can_sent(std::int64_t t) = 0;
  virtual void can_received(const CanFrame& frame, std::int64_t t) = 0;
  /// A frame ended in an error flag; `mine`: it was this node's.
  virtual void can_failed(CanError error, bool mine, std::int64_t t) = 0;

 protected:
  ~CanNode() = default;
};

/// The wires. A node attaches once and detaches before it goes.
class CanLine {
 public:
  virtual void attach(CanNode& node, std::int64_t t) = 0;
  virtual void detach(CanNode& node) = 0;
  /// What the node offers has changed, or whether it takes part.
  virtual void changed(CanNode& node, std::int64_t t) = 0;

 protected:
  ~CanLine() = default;
};

/// Error counters of a node, ISO 11898-1. The rules for errors inside of an error flag are left out.
class CanErrorCounters {
 public:
  static constexpr unsigned kWarning = 96;
  static constexpr unsigned kPassive = 128;
  static constexpr unsigned kBusOff = 256;

  void clear() { transmit_ = receive_ = 0; }
  unsigned transmit() const { return transmit_; }
  unsigned receive() const { return receive_; }
  bool warning() const { return transmit_ >= kWarning || receive_ >= kWarning; }
  bool passive() const { return transmit_ >= kPassive || receive_ >= kPassive; }
  bool bus_off() const { return transmit_ >= kBusOff; }

  void sent() { transmit_ -= transmit_ > 0 ? 1 : 0; }
  void received() { receive_ = receive_ >= kPassive ? kPassive - 9 : receive_ - (receive_ > 0 ? 1 : 0); }
  /// A passive node that misses the acknowledgment does not count: a node that is alone never goes bus-off.
  void transmit_failed(CanError error) {
    if (error != CanError::kAcknowledge || transmit_ < kPassive) transmit_ += 8;
  }
  void receive_failed(CanError error) {
    if (receive_ < kPassive) receive_ += error == CanError::kForm ? 9 : 1;
  }

 private:
  unsigned transmit_ = 0;
  unsigned receive_ = 0;
};

}  // namespace stillspin::chip

#endif

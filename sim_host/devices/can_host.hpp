// A node of the bus that programs on the host use: what is behind a USB adapter, or any other participant.
//
// Sends what is given to it in order, keeps what it hears with the time of its last bit. Its controller has error
// counters; bus-off it leaves by itself after 128 times 11 bits, noticed at the next event or call. It can listen only,
// and it can keep the bus busy with one frame for ever.

#ifndef STILLSPIN_SIM_HOST_DEVICES_CAN_HOST_HPP
#define STILLSPIN_SIM_HOST_DEVICES_CAN_HOST_HPP

#include <cstdint>
#include <deque>
#include <vector>

#include "sim_host/devices/can_bus.hpp"

namespace stillspin::devices {

class CanHost final : public CanNode {
 public:
  struct Heard {
    Tick t;
    CanFrame frame;
  };

  CanHost(CanBus& bus, Tick t) : bus_(bus) { bus_.attach(*this, t); }
  ~CanHost() { bus_.detach(*this); }
  CanHost(const CanHost&) = delete;
  CanHost& operator=(const CanHost&) = delete;

  /// bits/s of 1 Mbit/s or less, 0 takes it off the bus; what waits to be sent is dropped when it goes off.
  void set_bit_rate(std::uint32_t bits_per_second, Tick t);
  void set_listening_only(bool on) { listening_only_ = on; }
  void send(const CanFrame& frame, Tick t);
  std::size_t waiting() const { return queue_.size(); }
  /// Sends `frame` whenever nothing else waits, until stop_flood.
  void flood(const CanFrame& frame, Tick t);
  void stop_flood(Tick t);

  /// What was heard since the last call.
  std::vector<Heard> take_heard(Tick t);
  /// How many frames that would give.
  std::size_t heard() const { return heard_.size(); }
  std::uint64_t sent() const { return sent_; }
  const chip::CanErrorCounters& errors() const { return errors_; }
  std::uint64_t bus_offs() const { return bus_offs_; }

  std::int64_t can_bit_time() const override { return bus_off_ ? 0 : bit_time_; }
  const CanFrame* can_offer() override;
  bool can_error_passive() const override { return errors_.passive(); }
  bool can_acknowledges() const override { return !listening_only_; }
  void can_busy(std::int64_t t, bool mine) override;
  void can_quiet(std::int64_t, std::int64_t t) override { recover(t); }
  void can_sent(std::int64_t t) override;
  void can_received(const CanFrame& frame, std::int64_t t) override;
  void can_failed(CanError error, bool mine, std::int64_t t) override;

 private:
  void recover(Tick t);

  CanBus& bus_;
  std::deque<CanFrame> queue_;
  std::vector<Heard> heard_;
  CanFrame flood_;
  bool flooding_ = false;
  bool listening_only_ = false;
  chip::CanErrorCounters errors_;
  Tick bit_time_ = 0;
  bool bus_off_ = false;
  Tick back_at_ = 0;
  bool sending_flood_ = false;
  std::uint64_t sent_ = 0;
  std::uint64_t bus_offs_ = 0;
};

}  // namespace stillspin::devices

#endif

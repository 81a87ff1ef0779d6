#include "sim_host/devices/can_host.hpp"

namespace stillspin::devices {

constexpr Tick kRecoveryBits = 128 * 11;

void CanHost::set_bit_rate(std::uint32_t bits_per_second, Tick t) {
  bit_time_ = bits_per_second == 0 ? 0 : chip::kTicksPerSecond / static_cast<Tick>(bits_per_second);
  if (bit_time_ == 0) queue_.clear();
  errors_.clear();
  bus_off_ = false;
  bus_.changed(*this, t);
}

void CanHost::send(const CanFrame& frame, Tick t) {
  recover(t);
  queue_.push_back(frame);
  bus_.changed(*this, t);
}

void CanHost::flood(const CanFrame& frame, Tick t) {
  flood_ = frame;
  flooding_ = true;
  bus_.changed(*this, t);
}

void CanHost::stop_flood(Tick t) {
  flooding_ = false;
  bus_.changed(*this, t);
}

std::vector<CanHost::Heard> CanHost::take_heard(Tick t) {
  recover(t);
  std::vector<Heard> out;
  out.swap(heard_);
  return out;
}

const CanFrame* CanHost::can_offer() {
  if (listening_only_) return nullptr;
  if (!queue_.empty()) return &queue_.front();
  return flooding_ ? &flood_ : nullptr;
}

void CanHost::recover(Tick t) {
  if (!bus_off_ || t < back_at_) return;
  bus_off_ = false;
  errors_.clear();
  bus_.changed(*this, t);
}

// What is on offer when the frame has ended may be another than the one that was sent.
void CanHost::can_busy(std::int64_t, bool mine) {
  if (mine) sending_flood_ = queue_.empty();
}

void CanHost::can_sent(std::int64_t) {
  errors_.sent();
  ++sent_;
  if (!sending_flood_ && !queue_.empty()) queue_.pop_front();
}

void CanHost::can_received(const CanFrame& frame, std::int64_t t) {
  errors_.received();
  heard_.push_back(Heard{t, frame});
}

void CanHost::can_failed(CanError error, bool mine, std::int64_t t) {
  if (mine) {
    errors_.transmit_failed(error);
  } else {
    errors_.receive_failed(error);
  }
  if (!errors_.bus_off() || bus_off_) return;
  ++bus_offs_;
  bus_off_ = true;
  back_at_ = t + kRecoveryBits * bit_time_;
}

}  // namespace stillspin::devices

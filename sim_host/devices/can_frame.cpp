#include "sim_host/devices/can_frame.hpp"

namespace stillspin::devices {
namespace {

constexpr unsigned kCrcPolynomial = 0x4599;  // CRC-15-CAN
constexpr int kStuffAfter = 5;

// Counts bits with their stuff bits; the CRC runs over the unstuffed ones.
class BitCounter {
 public:
  void send(std::uint32_t value, int bits) {
    for (int i = bits - 1; i >= 0; --i) send_bit((value >> i & 1u) != 0);
  }
  void send_crc() { send(crc_, 15); }
  int bits() const { return bits_; }

 private:
  void send_bit(bool bit) {
    const bool overflow = bit != ((crc_ >> 14 & 1u) != 0);
    crc_ = crc_ << 1 & 0x7FFFu;
    if (overflow) crc_ ^= kCrcPolynomial;
    count(bit);
    if (equal_ == kStuffAfter) count(!bit);
  }
  void count(bool bit) {
    ++bits_;
    equal_ = bits_ > 1 && bit == last_ ? equal_ + 1 : 1;
    last_ = bit;
  }

  unsigned crc_ = 0;
  int bits_ = 0;
  int equal_ = 0;
  bool last_ = false;
};

}  // namespace

int can_frame_bits(const chip::CanFrame& frame) {
  BitCounter line;
  line.send(0, 1);
  if (frame.extended) {
    line.send(frame.id >> 18, 11);
    line.send(3, 2);  // SRR, IDE
    line.send(frame.id & 0x3FFFFu, 18);
    line.send(frame.remote ? 4 : 0, 3);  // RTR and two reserved
  } else {
    line.send(frame.id, 11);
    line.send(frame.remote ? 4 : 0, 3);  // RTR, IDE and one reserved
  }
  line.send(frame.length, 4);
  for (int i = 0; i < frame.length && !frame.remote; ++i) line.send(frame.data[static_cast<unsigned>(i)], 8);
  line.send_crc();
  return line.bits() + kCanTailBits;
}

std::uint32_t can_arbitration_key(const chip::CanFrame& frame) {
  const std::uint32_t remote = frame.remote ? 1 : 0;
  if (!frame.extended) return frame.id << 21 | remote << 20;
  return frame.id >> 18 << 21 | 3u << 19 | (frame.id & 0x3FFFFu) << 1 | remote;
}

}  // namespace stillspin::devices

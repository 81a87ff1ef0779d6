#include <algorithm>
#include <array>
#include <stdexcept>

#include "firmware/can/messages.h"
#include "firmware/can/segments.h"
#include "firmware/link/record.h"
#include "firmware/link/splitter.h"
#include "sim_host/bench/board_port.hpp"

namespace stillspin::bench {
namespace {

constexpr char kHex[] = "0123456789ABCDEF";
constexpr std::uint32_t kNoTime = 0;  // records that rest are not dropped: the next one begins anew

void check_length(const Words& record) {
  if (record.size() > RECORD_MAX - 2u) throw std::length_error("a record is too long");
}

class SerialFraming final : public Framing {
 public:
  SerialFraming() { splitter_reset(&splitter_); }

  Octets wrap(const Words& record) override {
    check_length(record);
    std::array<std::uint16_t, RECORD_MAX> sealed;
    std::array<std::uint16_t, RECORD_ENCODED_MAX + 2> wire;
    std::copy(record.begin(), record.end(), sealed.begin());
    const unsigned count = record_to_wire(sealed.data(), static_cast<std::uint16_t>(record.size()), wire.data());
    return Octets(wire.begin(), wire.begin() + count);
  }

  bool take(std::uint8_t octet) override { return splitter_octet(&splitter_, octet, kNoTime) == SPLITTER_RECORD; }

  Words record() const override { return Words(splitter_.octets, splitter_.octets + splitter_.count); }

 private:
  splitter_t splitter_;
};

class SlcanFraming final : public Framing {
 public:
  explicit SlcanFraming(unsigned node) : node_(static_cast<std::uint16_t>(node)) {
    if (node < 1 || node > 31) throw std::invalid_argument("a node on the CAN bus is 1 to 31");
    segment_join_reset(&joiner_);
    put_identifier(response_, can_frame(CAN_RECORD_RESPONSE, node_));
  }

  Octets wrap(const Words& record) override {
    check_length(record);
    std::copy(record.begin(), record.end(), splitter_.octets);
    segment_split_begin(&splitter_, static_cast<std::uint16_t>(record.size()), kNoTime);
    Octets octets;
    hal_can_frame_t frame = can_frame(CAN_RECORD_REQUEST, node_);
    while (segment_split_peek(&splitter_, &frame)) {
      put_identifier(octets, frame);
      octets.push_back(static_cast<std::uint8_t>('0' + frame.length));
      for (unsigned k = 0; k < frame.length; k++) put_hex(octets, frame.data[k], 2);
      octets.push_back('\r');
      segment_split_advance(&splitter_, kNoTime);
    }
    return octets;
  }

  bool take(std::uint8_t octet) override {
    if (octet != '\r' && octet != '\a') {
      if (line_.size() < kLongest) line_.push_back(octet);
      return false;
    }
    hal_can_frame_t frame{};
    const bool complete = read(frame) && segment_join(&joiner_, &frame, kNoTime);
    line_.clear();
    return complete;
  }

  Words record() const override { return Words(joiner_.octets, joiner_.octets + joiner_.count); }

 private:
  static constexpr std::size_t kLongest = 32;  // of a line of the adapter
  static constexpr std::size_t kHead = 5;      // t, three digits of the identifier, length

  static void put_hex(Octets& octets, unsigned value, unsigned digits) {
    for (unsigned k = digits; k-- > 0;) octets.push_back(static_cast<std::uint8_t>(kHex[value >> 4 * k & 0xFu]));
  }

  static void put_identifier(Octets& octets, const hal_can_frame_t& frame) {
    octets.push_back('t');
    put_hex(octets, frame.id, 3);
  }

  static int digit(std::uint8_t c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
  }

  // The line as a frame of the node's answers; false for every other, such as the adapter's own words. A time stamp
  // behind the data is not looked at.
  bool read(hal_can_frame_t& frame) const {
    if (line_.size() < kHead || !std::equal(response_.begin(), response_.end(), line_.begin())) return false;
    const int length = digit(line_[kHead - 1]);
    if (length < 0 || length > 8 || line_.size() < kHead + 2 * static_cast<std::size_t>(length)) return false;
    for (int k = 0; k < length; k++) {
      const int high = digit(line_[kHead + 2 * k]), low = digit(line_[kHead + 2 * k + 1]);
      if (high < 0 || low < 0) return false;
      frame.data[k] = static_cast<std::uint16_t>(high << 4 | low);
    }
    frame.length = static_cast<std::uint16_t>(length);
    return true;
  }

  std::uint16_t node_;
  Octets response_;  // how lines with an answer of the node begin
  Octets line_;
  segment_splitter_t splitter_{};
  segment_joiner_t joiner_{};
};

}  // namespace

std::unique_ptr<Framing> serial_framing() { return std::make_unique<SerialFraming>(); }

std::unique_ptr<Framing> slcan_framing(unsigned node) { return std::make_unique<SlcanFraming>(node); }

}  // namespace stillspin::bench

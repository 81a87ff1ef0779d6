#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "firmware/can/messages.h"
#include "firmware/can/segments.h"
#include "firmware/link/record.h"
#include "firmware/link/splitter.h"
#include "sim_host/bench/board_port.hpp"
#include "sim_host/bench/slcan_line.hpp"

namespace stillspin::bench {
namespace {

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
    response_ = can_frame(CAN_RECORD_RESPONSE, node_).id;
  }

  Octets wrap(const Words& record) override {
    check_length(record);
    std::copy(record.begin(), record.end(), splitter_.octets);
    segment_split_begin(&splitter_, static_cast<std::uint16_t>(record.size()), kNoTime);
    Octets octets;
    hal_can_frame_t frame = can_frame(CAN_RECORD_REQUEST, node_);
    while (segment_split_peek(&splitter_, &frame)) {
      chip::CanFrame piece;
      piece.id = frame.id;
      piece.length = static_cast<std::uint8_t>(frame.length);
      std::copy_n(frame.data, frame.length, piece.data.begin());
      put_slcan_line(octets, piece);
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

  // The line as a frame of the node's answers; false for every other, such as the adapter's own words. A time stamp
  // behind the data is not looked at.
  bool read(hal_can_frame_t& frame) const {
    std::string_view rest;
    const auto heard = slcan_frame({reinterpret_cast<const char*>(line_.data()), line_.size()}, rest);
    if (!heard || heard->id != response_) return false;
    frame.length = heard->length;
    std::copy(heard->data.begin(), heard->data.end(), frame.data);
    return true;
  }

  std::uint16_t node_;
  std::uint32_t response_;  // identifier of the node's answers
  Octets line_;
  segment_splitter_t splitter_{};
  segment_joiner_t joiner_{};
};

}  // namespace

std::unique_ptr<Framing> serial_framing() { return std::make_unique<SerialFraming>(); }

std::unique_ptr<Framing> slcan_framing(unsigned node) { return std::make_unique<SlcanFraming>(node); }

}  // namespace stillspin::bench

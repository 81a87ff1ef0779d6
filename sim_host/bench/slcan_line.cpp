#include "sim_host/bench/slcan_line.hpp"

namespace stillspin::bench {
namespace {

constexpr char kHex[] = "0123456789ABCDEF";
constexpr std::size_t kIdentifier = 3;          // digits
constexpr std::size_t kHead = 2 + kIdentifier;  // t, identifier, length
constexpr int kHighestIdentifier = 0x7FF;
constexpr int kMostOctets = 8;

void put_hex(std::vector<std::uint8_t>& octets, std::uint32_t value, unsigned digits) {
  for (unsigned k = digits; k-- > 0;) octets.push_back(static_cast<std::uint8_t>(kHex[value >> 4 * k & 0xFu]));
}

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

// -1 when it is no number.
int number(std::string_view digits) {
  int value = 0;
  for (const char c : digits) {
    const int d = digit(c);
    if (d < 0) return -1;
    value = value << 4 | d;
  }
  return value;
}

}  // namespace

void put_slcan_line(std::vector<std::uint8_t>& octets, const chip::CanFrame& frame) {
  octets.push_back(static_cast<std::uint8_t>((frame.remote ? "rR" : "tT")[frame.extended ? 1 : 0]));
  put_hex(octets, frame.id, frame.extended ? 8 : kIdentifier);
  put_hex(octets, frame.length, 1);
  for (unsigned k = 0; k < frame.length && !frame.remote; k++) put_hex(octets, frame.data[k], 2);
  octets.push_back('\r');
}

std::optional<chip::CanFrame> slcan_frame(std::string_view line, std::string_view& rest) {
  if (line.size() < kHead || line[0] != 't') return std::nullopt;
  const int id = number(line.substr(1, kIdentifier)), length = digit(line[kHead - 1]);
  if (id < 0 || id > kHighestIdentifier || length < 0 || length > kMostOctets) return std::nullopt;
  const std::size_t end = kHead + 2 * static_cast<std::size_t>(length);
  if (line.size() < end) return std::nullopt;
  chip::CanFrame frame;
  frame.id = static_cast<std::uint32_t>(id);
  frame.length = static_cast<std::uint8_t>(length);
  for (std::size_t k = 0; k < frame.length; k++) {
    const int octet = number(line.substr(kHead + 2 * k, 2));
    if (octet < 0) return std::nullopt;
    frame.data[k] = static_cast<std::uint8_t>(octet);
  }
  rest = line.substr(end);
  return frame;
}

}  // namespace stillspin::bench

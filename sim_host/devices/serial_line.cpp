#include "sim_host/devices/serial_line.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace stillspin::devices {
namespace {

constexpr unsigned kStopBit = 9;
constexpr double kMinimumRate = 10.0;
constexpr double kMaximumRate = 10e6;

}  // namespace

// ---- stretches -----------------------------------------------------------------------------------------

// The receiver asks for edges at every one of its samples and whenever the pins may have changed.
SerialLine::Stretch::Stretch(double from, double length, unsigned count, unsigned bit_levels)
    : begin(from), bit(length), bits(count), levels(bit_levels) {
  for (unsigned k = 0; k <= bits; ++k) edges[k] = static_cast<Tick>(std::ceil(begin + k * bit));
}

bool SerialLine::Stretch::level(Tick t) const {
  if (t < edge(0) || t >= end()) return true;
  auto index = std::min(static_cast<unsigned>((static_cast<double>(t) - begin) / bit), bits - 1);
  if (t < edge(index)) --index;  // rounding: the edges decide
  if (t >= edge(index + 1)) ++index;
  return (levels >> index & 1u) != 0;
}

// The first tick at or after t inside the stretch at which the line has the level, its end when there is none.
Tick SerialLine::in_stretch(const Stretch& s, Tick t, bool level) {
  if (s.level(t) == level && t < s.end()) return t;
  for (unsigned k = 0; k < s.bits; ++k) {
    const Tick edge = s.edge(k);
    if (edge > t && ((s.levels >> k & 1u) != 0) == level) return edge;
  }
  return s.end();
}

void SerialLine::append(unsigned levels, unsigned bits, double bit, Tick t) {
  double begin = static_cast<double>(t);
  if (!stretches_.empty())
    begin = std::max(begin, stretches_.back().begin + stretches_.back().bits * stretches_.back().bit);
  stretches_.emplace_back(begin, bit, bits, levels);
}

// ---- the far end ---------------------------------------------------------------------------------------

void SerialLine::set_rate(double bits_per_second) {
  if (!(bits_per_second >= kMinimumRate && bits_per_second <= kMaximumRate)) {
    throw std::invalid_argument("serial rate " + std::to_string(bits_per_second) + " bit/s: must be 10 to 10000000");
  }
  rate_ = bits_per_second;
}

void SerialLine::set_noise(double flips_per_bit, std::uint64_t seed) {
  if (!(flips_per_bit >= 0.0 && flips_per_bit <= 1.0)) {
    throw std::invalid_argument("serial noise " + std::to_string(flips_per_bit) + ": must be 0 to 1");
  }
  flips_ = flips_per_bit;
  random_.seed(seed);
}

unsigned SerialLine::noisy(unsigned levels, unsigned bits) {
  if (flips_ == 0.0) return levels;
  constexpr double kScale = 1.0 / 18446744073709551616.0;  // 2^-64
  for (unsigned k = 0; k < bits; ++k) {
    if (static_cast<double>(random_()) * kScale < flips_) levels ^= 1u << k;
  }
  return levels;
}

void SerialLine::send(const std::vector<std::uint8_t>& octets, Tick t) {
  const double bit = static_cast<double>(chip::kTicksPerSecond) / rate_;
  for (const std::uint8_t octet : octets) {
    append(noisy(static_cast<unsigned>(octet) << 1 | 1u << kStopBit, kFrameBits), kFrameBits, bit, t);
  }
  counts_.sent += octets.size();
}

void SerialLine::send_break(double bits, Tick t) {
  append(0, 1, bits * static_cast<double>(chip::kTicksPerSecond) / rate_, t);
}

std::vector<std::uint8_t> SerialLine::take() {
  std::vector<std::uint8_t> octets;
  octets.swap(arrived_);
  return octets;
}

Tick SerialLine::sent_until(Tick t) const { return stretches_.empty() ? t : std::max(t, stretches_.back().end()); }

// ---- the chip's end ------------------------------------------------------------------------------------

Tick SerialLine::reaches(Tick t, bool level) {
  while (!stretches_.empty() && stretches_.front().end() <= t) stretches_.pop_front();
  for (const Stretch& s : stretches_) {
    if (level && t < s.edge(0)) return t;
    const Tick from = std::max(t, s.edge(0));
    const Tick found = in_stretch(s, from, level);
    if (found < s.end()) return found;
    t = s.end();
  }
  return level ? t : chip::kNever;
}

bool SerialLine::level(Tick t) const {
  for (const Stretch& s : stretches_) {
    if (t < s.edge(0)) return true;
    if (t < s.end()) return s.level(t);
  }
  return true;
}

// Samples the middle of each bit at the far end's rate, from the falling edge of the start bit.
void SerialLine::receive(const chip::SerialFrame& frame) {
  chip_rate_ = static_cast<double>(chip::kTicksPerSecond) / static_cast<double>(frame.bit);
  const double ratio = static_cast<double>(chip::kTicksPerSecond) / rate_ / static_cast<double>(frame.bit);
  const auto sample = [&](unsigned index) {
    const auto bit = static_cast<unsigned>((index + 0.5) * ratio);
    return bit >= frame.bits || (frame.levels >> bit & 1u) != 0;
  };
  unsigned octet = 0;
  for (unsigned k = 0; k < 8; ++k) octet |= (sample(k + 1) ? 1u : 0u) << k;
  if (!sample(kStopBit)) {
    ++counts_.framing_errors;
    return;
  }
  ++counts_.received;
  arrived_.push_back(static_cast<std::uint8_t>(octet));
}

}  // namespace stillspin::devices

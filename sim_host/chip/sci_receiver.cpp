#include "sim_host/chip/sci_receiver.hpp"

#include <algorithm>

namespace stillspin::chip {
namespace {

constexpr Tick kSamplesPerBit = 8;
constexpr Tick kStartSamples = 4;
constexpr Tick kFirstVote = 4;
constexpr Tick kLastVote = 6;
constexpr Tick kBreakBits = 10;
constexpr Tick kMostCycles = 65536;  // of an eighth of a bit

}  // namespace

bool sci_parity_bit(unsigned data, bool even) {
  const bool odd_count = (__builtin_popcount(data) & 1) != 0;
  return odd_count == even;
}

void SciReceiver::stop() {
  state_ = State::kOff;
  next_event_ = kNever;
}

void SciReceiver::measure(const SciFormat& format, Tick cycle, Tick t) {
  listen(format, t);
  cycle_ = cycle;
}

void SciReceiver::listen(const SciFormat& format, Tick t) {
  format_ = format;
  cycle_ = 0;
  wait_for_start(t);
}

void SciReceiver::wait_for_start(Tick t) {
  state_ = State::kIdle;
  next_event_ = services_.serial_reaches(t, false);
}

void SciReceiver::wait_for_rise(Tick t) { next_event_ = std::min(services_.serial_reaches(t, true), break_at_); }

void SciReceiver::line_changed(Tick t) {
  if (state_ == State::kIdle) wait_for_start(t);
  if (state_ == State::kLow) wait_for_rise(t);
  if (state_ == State::kMeasure) next_event_ = services_.serial_reaches(t, true);
}

SciReceiver::Outcome SciReceiver::run_event(Tick t) {
  switch (state_) {
    case State::kIdle:
      start_ = t;
      state_ = cycle_ == 0 ? State::kStart : State::kMeasure;
      next_event_ = cycle_ == 0 ? t + kStartSamples * format_.sample : services_.serial_reaches(t, true);
      return Outcome::kNothing;
    case State::kMeasure:
      take_length(t);
      return Outcome::kNothing;
    case State::kStart:
      check_start(t);
      return Outcome::kNothing;
    case State::kFrame:
      return read_frame(t);
    case State::kLow:
      return end_low(t);
    case State::kOff:
      break;
  }
  next_event_ = kNever;
  return Outcome::kNothing;
}

// A glitch that is shorter than half a bit is no start bit.
void SciReceiver::check_start(Tick t) {
  for (Tick k = 1; k <= kStartSamples; ++k) {
    const Tick sample = start_ + k * format_.sample;
    if (!level(sample)) continue;
    wait_for_start(sample);
    next_event_ = std::max(next_event_, t);
    return;
  }
  await_frame();
}

// The first bit has ended at t.
void SciReceiver::take_length(Tick t) {
  const Tick unit = kSamplesPerBit * cycle_;
  const Tick cycles = (t - start_ + unit / 2) / unit;
  if (cycles < 1 || cycles > kMostCycles) {
    wait_for_start(t);
    return;
  }
  format_.sample = cycles * cycle_;
  await_frame();
}

void SciReceiver::await_frame() {
  state_ = State::kFrame;
  const Tick stop_bit = format_.frame_bits() - format_.stop_bits;
  next_event_ = start_ + (kSamplesPerBit * stop_bit + kLastVote) * format_.sample;
}

bool SciReceiver::bit(unsigned index) const {
  int high = 0;
  for (Tick k = kFirstVote; k <= kLastVote; ++k) {
    high += level(start_ + (kSamplesPerBit * index + k) * format_.sample) ? 1 : 0;
  }
  return high >= 2;
}

SciReceiver::Outcome SciReceiver::read_frame(Tick t) {
  character_ = SciCharacter{};
  unsigned index = 1;
  for (unsigned k = 0; k < format_.data_bits; ++k, ++index) {
    character_.data = static_cast<std::uint16_t>(character_.data | (bit(index) ? 1u << k : 0u));
  }
  if (format_.parity) character_.parity_error = bit(index++) != sci_parity_bit(character_.data, format_.even);
  character_.framing_error = !bit(index);
  if (cycle_ != 0 && (character_.framing_error || (character_.data | 0x20u) != 'a')) {
    wait_for_start(t);
    return Outcome::kNothing;
  }
  cycle_ = 0;
  if (!character_.framing_error || level(t)) {
    wait_for_start(t);
  } else {
    state_ = State::kLow;
    break_at_ = t + kBreakBits * format_.bit();
    wait_for_rise(t);
  }
  return Outcome::kCharacter;
}

SciReceiver::Outcome SciReceiver::end_low(Tick t) {
  if (level(t)) {
    wait_for_start(t);
    return Outcome::kNothing;
  }
  if (t < break_at_) {
    wait_for_rise(t);
    return Outcome::kNothing;
  }
  stop();
  return Outcome::kBreak;
}

}  // namespace stillspin::chip

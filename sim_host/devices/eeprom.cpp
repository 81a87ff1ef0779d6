#include "sim_host/devices/eeprom.hpp"

namespace stillspin::devices {
namespace {

constexpr unsigned kAddressMask = Eeprom::kSize - 1;
constexpr unsigned kOctet = 8;

// A small generator: the same seed tears the same way everywhere.
std::uint32_t next_random(std::uint32_t& x) {
  x = x * 1664525u + 1013904223u;
  return x >> 16;
}

std::uint8_t torn_octet(Eeprom::Torn torn, unsigned at, std::uint8_t before, std::uint8_t after, std::uint32_t& seed) {
  const bool first_half = at < Eeprom::kPage / 2;
  switch (torn) {
    case Eeprom::Torn::kOld:
      return before;
    case Eeprom::Torn::kNew:
      return after;
    case Eeprom::Torn::kFirstHalf:
      return first_half ? after : before;
    case Eeprom::Torn::kLastHalf:
      return first_half ? before : after;
    case Eeprom::Torn::kErased:
      return 0xFF;
    case Eeprom::Torn::kMixed:
      break;
  }
  const std::uint32_t dice = next_random(seed);
  const std::uint8_t choices[] = {before, after, static_cast<std::uint8_t>(before & after),
                                  static_cast<std::uint8_t>(next_random(seed))};
  return choices[dice % 4];
}

}  // namespace

// ---- power -------------------------------------------------------------------------------------------------------

void Eeprom::power_off(Tick t, Torn torn, std::uint32_t seed) {
  finish_write(t);
  if (pending_) tear(torn, seed);
  pending_ = false;
  on_ = false;
  busy_until_ = 0;
  state_ = State::kIdle;
  latched_ = 0;
  answer_ = true;
}

void Eeprom::power_on() {
  on_ = true;
  cut_octets_ = cut_cycle_ = 0;
}

void Eeprom::cut_in_write_cycle(std::uint64_t cycles, Torn torn, std::uint32_t seed) {
  cut_cycle_ = cycles == 0 ? 0 : write_cycles_ + cycles;
  cut_torn_ = torn;
  cut_seed_ = seed;
}

void Eeprom::tear(Torn torn, std::uint32_t seed) {
  for (unsigned n = 0; n < kPage; ++n) {
    std::uint8_t& cell = memory_[page_ * kPage + n];
    const bool sent = (latched_ >> n & 1u) != 0;
    cell = torn_octet(torn, n, cell, sent ? latch_[n] : cell, seed);
  }
}

// ---- write cycle -------------------------------------------------------------------------------------------------

void Eeprom::begin_write_cycle(Tick t) {
  pending_ = true;
  busy_until_ = t + kWriteCycle;
  ++write_cycles_;
  ++wear_[page_];
  if (write_cycles_ == cut_cycle_) power_off(t, cut_torn_, cut_seed_);
}

void Eeprom::finish_write(Tick t) {
  if (!pending_ || t < busy_until_) return;
  pending_ = false;
  tear(Torn::kNew, 0);
  latched_ = 0;
}

// ---- lines -------------------------------------------------------------------------------------------------------

void Eeprom::drive(Tick t, bool sda, bool scl) {
  finish_write(t);
  const bool was_low = !(others_sda_ && lets_sda_go());
  const bool was_scl = scl_;
  others_sda_ = sda;
  scl_ = scl;
  if (scl && !was_scl && held_clocks_ > 0) --held_clocks_;
  if (!on_) return;
  const bool low = !(sda && lets_sda_go());
  if (was_scl && scl) {
    if (low && !was_low) on_start();
    if (!low && was_low) on_stop(t);
  } else if (scl) {
    on_clock_rise(!low);
  } else if (was_scl) {
    on_clock_fall(t);
  }
}

void Eeprom::on_start() {
  state_ = State::kControl;
  bits_ = shift_ = 0;
  latched_ = pending_ ? latched_ : 0;
  answer_ = true;
}

void Eeprom::on_stop(Tick t) {
  const bool writes = state_ == State::kWrite && latched_ != 0 && !pending_;
  state_ = State::kIdle;
  answer_ = true;
  if (writes) begin_write_cycle(t);
}

void Eeprom::on_clock_rise(bool sda) {
  if (state_ == State::kIdle || state_ == State::kIgnore) return;
  if (bits_ < kOctet) shift_ = (shift_ << 1 | (sda ? 1u : 0u)) & 0xFFu;
  if (bits_ == kOctet) acknowledged_ = !sda;
  ++bits_;
}

// An octet is over with the falling edge behind its last bit, its acknowledge with the next one.
void Eeprom::on_clock_fall(Tick t) {
  if (state_ == State::kIdle || state_ == State::kIgnore || bits_ == 0) return;
  if (bits_ < kOctet) {
    if (state_ == State::kRead) present();
    return;
  }
  if (bits_ == kOctet) {
    answer_ = true;
    ++octets_;
    if (octets_ == cut_octets_) {
      power_off(t);
      return;
    }
    if (state_ != State::kRead) take_octet();
    return;
  }
  bits_ = 0;
  answer_ = true;
  if (state_ != State::kRead) return;
  if (!acknowledged_) {
    state_ = State::kIgnore;
    return;
  }
  reading_ = memory_[address_];
  address_ = (address_ + 1) & kAddressMask;
  present();
}

/// Puts the next bit of the octet that is being read on the line.
void Eeprom::present() { answer_ = (reading_ >> (7 - bits_) & 1u) != 0; }

void Eeprom::take_octet() {
  switch (state_) {
    case State::kControl:
      take_control();
      return;
    case State::kAddressHigh:
      address_ = shift_ << 8 & kAddressMask;
      state_ = State::kAddressLow;
      break;
    case State::kAddressLow:
      address_ |= shift_;
      page_ = address_ / kPage;
      state_ = State::kWrite;
      break;
    case State::kWrite:
      latch_[address_ % kPage] = static_cast<std::uint8_t>(shift_);
      latched_ |= std::uint64_t{1} << address_ % kPage;
      address_ = page_ * kPage + (address_ + 1) % kPage;
      break;
    default:
      return;
  }
  answer_ = false;
}

void Eeprom::take_control() {
  if (pending_ || shift_ >> 1 != kAddress) {
    state_ = State::kIgnore;
    return;
  }
  answer_ = false;
  state_ = State::kAddressHigh;
  if ((shift_ & 1u) == 0) return;
  state_ = State::kRead;
  acknowledged_ = true;  // its own
}

}  // namespace stillspin::devices

// The EEPROM on the I2C lines: a 24LC256 at address 0x50, 32 KiB in pages of 64 octets.
//
// It watches the two lines level by level. A write fills the page latches, wrapping inside the page; the stop condition
// begins the write cycle of 5 ms, during which the device does not answer to its address. A start or a power cut before
// the stop writes nothing. A power cut during the write cycle leaves the page old, new, or anything in between, and the
// caller says which. Reads go on from the address counter, round the whole memory. Every write cycle wears its page.
//
// Faults: the power may be cut after any octet on the bus or at any write cycle; SDA may be held low until the clock
// has come so many times, as a device does that was left in the middle of an octet; the device may be gone. Not
// modelled: write protection, the cells' limited life, times of set-up and hold. Source: Microchip DS20001203.

#ifndef STILLSPIN_SIM_HOST_DEVICES_EEPROM_HPP
#define STILLSPIN_SIM_HOST_DEVICES_EEPROM_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "sim_host/chip/world.hpp"

namespace stillspin::devices {

using chip::Tick;

class Eeprom {
 public:
  static constexpr unsigned kSize = 32768;
  static constexpr unsigned kPage = 64;
  static constexpr unsigned kPages = kSize / kPage;
  static constexpr unsigned kAddress = 0x50;
  static constexpr Tick kWriteCycle = 500'000;  // 5 ms, the longest

  /// What a power cut makes of the page that is being written.
  enum class Torn {
    kOld,
    kNew,
    kFirstHalf,  // the first half is new
    kLastHalf,
    kErased,  // no octet has been written back yet
    kMixed    // each octet old, new or neither, by `seed`
  };

  Eeprom() : memory_(kSize, 0xFF), wear_(kPages, 0) {}

  /// What the others on the bus do: true lets the line go, false pulls it low.
  void drive(Tick t, bool sda, bool scl);

  /// Whether the device lets SDA go; it never holds SCL.
  bool lets_sda_go() const { return answer_ && held_clocks_ == 0; }

  // ---- content and wear
  const std::vector<std::uint8_t>& memory() const { return memory_; }
  std::vector<std::uint8_t>& memory() { return memory_; }
  std::uint32_t wear(unsigned page) const { return wear_[page]; }
  std::uint64_t write_cycles() const { return write_cycles_; }
  std::uint64_t octets() const { return octets_; }  // on the bus so far, addresses included, acknowledged or not
  bool is_writing(Tick t) const { return t < busy_until_; }

  // ---- power
  /// Off at t: the device forgets what it was doing and answers to nothing. A page being written becomes `torn`.
  void power_off(Tick t, Torn torn = Torn::kOld, std::uint32_t seed = 0);
  void power_on();
  bool is_on() const { return on_; }

  // ---- faults
  /// The power goes behind so many further octets on the bus, or in the n-th further write cycle; 0 never.
  void cut_after_octets(std::uint64_t octets) { cut_octets_ = octets == 0 ? 0 : octets_ + octets; }
  void cut_in_write_cycle(std::uint64_t cycles, Torn torn, std::uint32_t seed = 0);

  /// Holds SDA low until SCL has risen `clocks` times; 0 lets go.
  void hold_sda(unsigned clocks) { held_clocks_ = clocks; }

 private:
  enum class State { kIdle, kControl, kAddressHigh, kAddressLow, kWrite, kRead, kIgnore };

  void on_start();
  void on_stop(Tick t);
  void on_clock_rise(bool sda);
  void on_clock_fall(Tick t);
  void take_octet();
  void take_control();
  void present();
  void finish_write(Tick t);
  void begin_write_cycle(Tick t);
  void tear(Torn torn, std::uint32_t seed);

  std::vector<std::uint8_t> memory_;
  std::vector<std::uint32_t> wear_;
  bool on_ = true;

  // The lines, as they were.
  bool others_sda_ = true, scl_ = true;
  bool answer_ = true;  // false: the device pulls SDA low
  unsigned held_clocks_ = 0;

  State state_ = State::kIdle;
  unsigned bits_ = 0;  // of the octet, 0..8, 9 while it is acknowledged
  unsigned shift_ = 0;
  bool acknowledged_ = false;  // by the master, of an octet that was read
  std::uint8_t reading_ = 0;
  unsigned address_ = 0;

  // The page latches and the write cycle.
  std::array<std::uint8_t, kPage> latch_{};
  std::uint64_t latched_ = 0;  // a bit for each octet that was sent
  unsigned page_ = 0;
  Tick busy_until_ = 0;
  bool pending_ = false;  // a write cycle has begun and its page is not in the memory yet

  std::uint64_t write_cycles_ = 0, octets_ = 0;
  std::uint64_t cut_octets_ = 0, cut_cycle_ = 0;
  Torn cut_torn_ = Torn::kOld;
  std::uint32_t cut_seed_ = 0;
};

}  // namespace stillspin::devices

#endif

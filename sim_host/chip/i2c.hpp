// I2C-A as a master, level by level on its two lines.
//
// The module clock is SYSCLKOUT / (IPSC + 1); a bit has a low time of CLKL + d and a high time of CLKH + d module
// clocks, d = 7, 6, 5 for IPSC = 0, 1, more. SDA changes with the falling edge of SCL and is looked at when the high
// time ends. A line that somebody else holds low stays low: SCL is waited for, SDA low where a 1 was sent is a lost
// arbitration.
//     MDR.STT   starts (again) with the address in SAR and the direction in TRX, as soon as both lines are high
//     MDR.STP   stops when CNT octets have gone (0: 65536), or at once when the module waits; without it the module
//     sets
//               ARDY then and waits for STT or STP with SCL low. MST and STP fall when the stop is on the bus.
//     MDR.RM    no count: goes on until STP or STT
//     no acknowledge from the other side: NACK and ARDY; waits for STP, or stops by itself when STP was set already
// Transmit data come from DXR or a FIFO of 16, received ones go to DRR or a FIFO of 16; while there is none, or no
// room, SCL is held low. The last octet of a count that is received is not acknowledged.
//
// What laziness costs: an SCL that somebody else stretches is looked at again a low time later. BB is that of the
// module's own transfers. Not modelled: slave, 10-bit addresses, free data format, loopback, octets of less than 8 bits
// (an error when a start asks for them), other masters' starts and stops. Sources: TI SPRU721 (I2C) and SPRUH18 of a
// sister, register reset values from memory; what happens at a NACK as TI's examples treat it.

#ifndef STILLSPIN_SIM_HOST_CHIP_I2C_HPP
#define STILLSPIN_SIM_HOST_CHIP_I2C_HPP

#include <array>
#include <cstdint>

#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

class I2c final : public Peripheral {
 public:
  explicit I2c(ChipServices& services) : services_(services) {}

  void reset(Tick t) override;
  std::uint16_t read(std::uint16_t offset, Tick t) override;
  void write(std::uint16_t offset, std::uint16_t value, Tick t) override;
  Tick next_event() const override { return next_event_; }
  void run_event(Tick t) override;
  void clocks_changed(Tick t) override;

 private:
  /// What the next event ends.
  enum class Phase {
    kIdle,
    kWaitFree,     // a start is wanted, the bus is not free
    kStartHold,    // SDA has fallen, SCL still high
    kLow,          // of a bit
    kStretched,    // SCL let go, but low
    kHigh,         // of a bit
    kHoldData,     // SCL low: no octet to send, no room for one
    kHoldCommand,  // SCL low: STT or STP is waited for
    kRestartLow,
    kRestartHigh,
    kStopLow,
    kStopHigh
  };

  class Fifo {
   public:
    static constexpr unsigned kDepth = 16;
    void clear() { count_ = 0; }
    unsigned count() const { return count_; }
    void push(std::uint16_t octet) { octets_[(first_ + count_++) % kDepth] = octet; }
    std::uint16_t pop() {
      const std::uint16_t octet = octets_[first_];
      first_ = (first_ + 1) % kDepth;
      --count_;
      return octet;
    }

   private:
    std::array<std::uint16_t, kDepth> octets_{};
    unsigned first_ = 0, count_ = 0;
  };

  // The bus (i2c.cpp).
  bool mode(unsigned mask) const { return (mode_ & mask) != 0; }
  Tick module_clocks(unsigned divider) const;
  Tick low_time() const { return module_clocks(clock_low_); }
  Tick high_time() const { return module_clocks(clock_high_); }
  void lines(bool sda, bool scl, Tick t);
  void enter(Phase phase, Tick until);
  void try_start(Tick t);
  void put_start(Tick t);
  void begin_bit(Tick t);
  void release_clock(Phase then, Tick t);
  void end_bit(Tick t);
  void end_octet(Tick t);
  void go_on(Tick t);
  void begin_octet(unsigned octet, Tick t);
  void begin_stop(Tick t);
  void end_stop(Tick t);
  void lose_arbitration(Tick t);
  bool is_last() const;
  bool is_finished() const;
  void command(Tick t);
  void release_bus(Tick t);
  bool is_supported() const;

  // Registers, flags and FIFOs (i2c_registers.cpp).
  void write_mode(std::uint16_t value, Tick t);
  void write_fifo_transmit(std::uint16_t value, Tick t);
  void write_fifo_receive(std::uint16_t value, Tick t);
  std::uint16_t status() const;
  std::uint16_t read_source();
  std::uint16_t fifo_register(std::uint16_t stored, const Fifo& fifo, bool flag) const;
  void set_flag(unsigned mask, Tick t);
  void note_levels(Tick t);
  unsigned capacity() const;

  ChipServices& services_;
  Phase phase_ = Phase::kIdle;
  Tick next_event_ = kNever;
  Tick rest_ = kNever;      // of the phase, while the clock is gated
  Tick bus_free_from_ = 0;  // a low time after the last stop
  Tick sysclk_period_ = 1;
  bool clocked_ = false;
  bool sda_ = true, scl_ = true;  // true: let go

  unsigned shift_ = 0;    // octet on its way
  unsigned bit_ = 0;      // 0..7, 8 is the acknowledge
  bool address_ = false;  // it is the address
  bool receive_ = false;  // direction of the octets behind the address
  Phase after_stretch_ = Phase::kHigh;
  bool acknowledged_ = false;
  std::uint32_t left_ = 0;  // octets still to go

  std::uint16_t own_address_ = 0, interrupt_enable_ = 0, clock_low_ = 0, clock_high_ = 0, count_ = 0;
  std::uint16_t slave_address_ = 0x3FF, mode_ = 0, prescale_ = 0, fifo_transmit_ = 0, fifo_receive_ = 0;
  std::uint16_t transmit_ = 0, received_ = 0;  // DXR and DRR as they are read back
  unsigned flags_ = 0;                         // of I2CSTR, those that are latched
  unsigned pending_ = 0;                       // of I2CISRC
  bool busy_ = false;                          // BB
  bool fifo_transmit_flag_ = false, fifo_receive_flag_ = false;
  Fifo to_send_, got_;
};

}  // namespace stillspin::chip

#endif

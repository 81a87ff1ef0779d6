// The I2C module alone: what it puts on the lines and when, acknowledges, counts, FIFOs, flags, interrupts.

#include "sim_host/chip/i2c.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <string>

#include "hal/f2808/registers.h"
#include "tests/chip/peripheral.hpp"

namespace stillspin::chip::testing {
namespace {

constexpr std::uint16_t kOn = I2C_MDR_IRS_MASK | I2C_MDR_FREE_MASK;
constexpr std::uint16_t kStart = kOn | I2C_MDR_MST_MASK | I2C_MDR_STT_MASK;
constexpr std::uint16_t kSend = kStart | I2C_MDR_TRX_MASK;
constexpr Tick kBit = 250;  // 400 kbit/s

// The other side of the bus: writes down S, P and octets ("A0+" acknowledged, "A0-" not), answers as it is told.
class Listener {
 public:
  explicit Listener(RecordingServices& services) {
    services.on_i2c = [this](Tick t, bool sda, bool scl) { drive(t, sda, scl); };
    services.sda_line = [this](Tick) { return sda(); };
    services.scl_line = [this](Tick) { return scl_ && !hold_scl; };
  }

  std::string seen;
  std::deque<unsigned> gives;    // octets for a read
  std::deque<bool> acknowledge;  // of the octets sent here; all when empty
  bool hold_sda = false, hold_scl = false;
  Tick last_rise = 0, low = 0, high = 0;  // lengths of SCL's levels, the last ones

 private:
  bool sda() const { return master_ && answer_ && !hold_sda; }

  void drive(Tick t, bool sda_released, bool scl) {
    const bool before = sda();
    const bool was_scl = scl_;
    master_ = sda_released;
    scl_ = scl;
    if (was_scl && scl && before != sda()) {
      seen += before ? "S " : "P ";
      bits_ = 0;
      sends_ = false;
      first_ = true;
      gone_ = false;
      answer_ = true;
    }
    if (!was_scl && scl) rise(t);
    if (was_scl && !scl) fall(t);
  }

  void rise(Tick t) {
    low = t - last_fall_;
    last_rise = t;
    if (bits_ < 8) octet_ = (octet_ << 1 | (sda() ? 1u : 0u)) & 0xFF;
    if (bits_ == 8) {
      char text[8];
      std::snprintf(text, sizeof text, "%02X%c ", octet_, sda() ? '-' : '+');
      seen += text;
      if (sends_ && sda()) gone_ = true;  // what is sent is wanted no more
    }
    ++bits_;
  }

  void fall(Tick t) {
    high = t - last_rise;
    last_fall_ = t;
    if (bits_ == 8) {
      answer_ = true;
      if (!sends_) {
        answer_ = !acknowledge.empty() && !acknowledge.front();
        if (!acknowledge.empty()) acknowledge.pop_front();
      }
    } else if (bits_ == 9) {
      bits_ = 0;
      answer_ = true;
      if (first_) sends_ = (octet_ & 1u) != 0;
      first_ = false;
      if (sends_ && !gives.empty()) {
        out_ = gives.front();
        gives.pop_front();
      }
    }
    if (bits_ < 8 && sends_ && !gone_) answer_ = (out_ >> (7 - bits_) & 1u) != 0;
  }

  bool master_ = true, scl_ = true, answer_ = true, sends_ = false, first_ = true, gone_ = false;
  unsigned bits_ = 0, octet_ = 0, out_ = 0xFF;
  Tick last_fall_ = 0;
};

class I2cBus : public ::testing::Test {
 protected:
  void SetUp() override {
    i2c.reset(0);
    set(I2C_PSC, 9);  // 10 MHz
    set(I2C_CLKL, 8);
    set(I2C_CLKH, 7);
    set(I2C_MDR, kOn);
  }

  void set(std::uint16_t offset, unsigned value) { i2c.write(offset, static_cast<std::uint16_t>(value), now); }
  std::uint16_t get(std::uint16_t offset) { return i2c.read(offset, now); }
  void run(Tick ticks) {
    now += ticks;
    run_until(i2c, now);
  }
  void use_fifos() {
    set(I2C_FFTX, I2C_FFTX_I2CFFEN_MASK | I2C_FFTX_TXFFRST_MASK);
    set(I2C_FFRX, I2C_FFRX_RXFFRST_MASK);
  }
  void start(unsigned mode, unsigned count, unsigned address = 0x50) {
    set(I2C_SAR, address);
    set(I2C_CNT, count);
    set(I2C_MDR, mode);
  }
  bool flag(unsigned mask) { return (get(I2C_STR) & mask) != 0; }
  bool mode(unsigned mask) { return (get(I2C_MDR) & mask) != 0; }

  RecordingServices services;
  Listener bus{services};
  I2c i2c{services};
  Tick now = 1000;
};

TEST_F(I2cBus, ResetValues) {
  i2c.reset(now);
  EXPECT_EQ(get(I2C_STR), 0x0410);
  EXPECT_EQ(get(I2C_MDR), 0);
  EXPECT_EQ(get(I2C_SAR), 0x3FF);
  EXPECT_EQ(i2c.next_event(), kNever);
}

TEST_F(I2cBus, SendsACountAndStops) {
  use_fifos();
  for (const unsigned octet : {0x12u, 0x34u, 0xA5u}) set(I2C_DXR, octet);
  start(kSend | I2C_MDR_STP_MASK, 3);
  EXPECT_TRUE(flag(I2C_STR_BB_MASK));
  run(20 * kBit);
  EXPECT_TRUE(mode(I2C_MDR_MST_MASK));
  EXPECT_FALSE(flag(I2C_STR_SCD_MASK));
  run(20 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ 12+ 34+ A5+ P ");
  EXPECT_FALSE(flag(I2C_STR_BB_MASK));
  EXPECT_TRUE(flag(I2C_STR_SCD_MASK));
  EXPECT_FALSE(mode(I2C_MDR_MST_MASK | I2C_MDR_STP_MASK | I2C_MDR_STT_MASK));
  EXPECT_EQ(i2c.next_event(), kNever);
}

TEST_F(I2cBus, BitTimesComeFromTheModuleClock) {
  struct Case {
    unsigned prescale, low, high;
    Tick low_ticks, high_ticks;
  };
  for (const Case& c : {Case{9, 8, 7, 130, 120}, Case{0, 10, 20, 17, 27}, Case{1, 10, 10, 32, 32}}) {
    set(I2C_MDR, 0);
    set(I2C_PSC, c.prescale);
    set(I2C_CLKL, c.low);
    set(I2C_CLKH, c.high);
    set(I2C_MDR, kOn);
    set(I2C_DXR, 0x55);
    start(kSend | I2C_MDR_STP_MASK, 1);
    run(10 * (c.low_ticks + c.high_ticks));
    EXPECT_EQ(bus.low, c.low_ticks);
    EXPECT_EQ(bus.high, c.high_ticks);
    run(100 * kBit);
  }
}

TEST_F(I2cBus, ReadsWithARepeatedStart) {
  use_fifos();
  set(I2C_DXR, 0x00);
  set(I2C_DXR, 0x40);
  start(kSend, 2);
  run(40 * kBit);
  EXPECT_TRUE(flag(I2C_STR_ARDY_MASK));
  EXPECT_TRUE(flag(I2C_STR_BB_MASK)) << "the bus is held";
  bus.gives = {0xDE, 0xAD, 0x01};
  start(kStart | I2C_MDR_STP_MASK, 3);
  run(50 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ 00+ 40+ S A1+ DE+ AD+ 01- P ");
  EXPECT_EQ(get(I2C_FFRX) >> I2C_FFRX_RXFFST_LSB & 0x1F, 3);
  EXPECT_EQ(get(I2C_DRR), 0xDE);
  EXPECT_EQ(get(I2C_DRR), 0xAD);
  EXPECT_EQ(get(I2C_DRR), 0x01);
  EXPECT_FALSE(flag(I2C_STR_RRDY_MASK));
}

TEST_F(I2cBus, HoldsTheClockWhenItHasNothingToSend) {
  use_fifos();
  start(kSend | I2C_MDR_STP_MASK, 2);
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ ");
  EXPECT_FALSE(flag(I2C_STR_XSMT_MASK));
  set(I2C_DXR, 1);
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ 01+ ");
  set(I2C_DXR, 2);
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ 01+ 02+ P ");
}

TEST_F(I2cBus, HoldsTheClockWhenItHasNoRoom) {
  use_fifos();
  for (unsigned n = 0; n < 20; ++n) bus.gives.push_back(n);
  start(kStart | I2C_MDR_STP_MASK, 20);
  run(1000 * kBit);
  EXPECT_TRUE(flag(I2C_STR_RSFULL_MASK));
  EXPECT_EQ(get(I2C_FFRX) >> I2C_FFRX_RXFFST_LSB & 0x1F, 16);
  for (unsigned n = 0; n < 20; ++n) {
    EXPECT_EQ(get(I2C_DRR), n);
    run(20 * kBit);
  }
  EXPECT_FALSE(flag(I2C_STR_BB_MASK));
}

TEST_F(I2cBus, WithoutFifosOneOctetWaits) {
  bus.gives = {1, 2};
  start(kStart | I2C_MDR_STP_MASK, 2);
  run(100 * kBit);
  EXPECT_TRUE(flag(I2C_STR_RSFULL_MASK));
  EXPECT_EQ(get(I2C_DRR), 1);
  run(100 * kBit);
  EXPECT_EQ(get(I2C_DRR), 2);
  EXPECT_EQ(bus.seen, "S A1+ 01+ 02- P ");
}

TEST_F(I2cBus, NoAnswerToTheAddress) {
  bus.acknowledge = {false};
  set(I2C_DXR, 1);
  start(kSend, 1);
  run(100 * kBit);
  EXPECT_TRUE(flag(I2C_STR_NACK_MASK));
  EXPECT_TRUE(flag(I2C_STR_ARDY_MASK));
  EXPECT_EQ(bus.seen, "S A0- ");
  set(I2C_STR, I2C_STR_NACK_MASK);
  EXPECT_FALSE(flag(I2C_STR_NACK_MASK));
  set(I2C_MDR, kOn | I2C_MDR_MST_MASK | I2C_MDR_STP_MASK);
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A0- P ");
  EXPECT_FALSE(flag(I2C_STR_BB_MASK));
}

TEST_F(I2cBus, NoAnswerToAnOctetStopsWhenAStopWasAskedFor) {
  use_fifos();
  bus.acknowledge = {true, true, false};
  for (unsigned n = 0; n < 5; ++n) set(I2C_DXR, n);
  start(kSend | I2C_MDR_STP_MASK, 5);
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ 00+ 01- P ");
  EXPECT_TRUE(flag(I2C_STR_NACK_MASK));
  EXPECT_FALSE(mode(I2C_MDR_MST_MASK));
}

TEST_F(I2cBus, SdaHeldLowIsALostArbitration) {
  set(I2C_DXR, 0xFF);
  start(kSend | I2C_MDR_STP_MASK, 1);
  run(11 * kBit);
  bus.hold_sda = true;
  run(10 * kBit);
  EXPECT_TRUE(flag(I2C_STR_AL_MASK));
  EXPECT_FALSE(mode(I2C_MDR_MST_MASK));
  EXPECT_FALSE(flag(I2C_STR_BB_MASK));
  EXPECT_EQ(i2c.next_event(), kNever) << "off the bus";
}

TEST_F(I2cBus, AStartWaitsForAFreeBus) {
  bus.hold_sda = true;
  set(I2C_DXR, 0x77);
  start(kSend | I2C_MDR_STP_MASK, 1);
  run(1000 * kBit);
  EXPECT_EQ(bus.seen, "");
  EXPECT_TRUE(mode(I2C_MDR_STT_MASK));
  bus.hold_sda = false;
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ 77+ P ");
}

TEST_F(I2cBus, AStretchedClockIsWaitedFor) {
  set(I2C_DXR, 0x77);
  start(kSend | I2C_MDR_STP_MASK, 1);
  run(5 * kBit);
  bus.hold_scl = true;
  run(1000 * kBit);
  EXPECT_TRUE(flag(I2C_STR_BB_MASK));
  bus.hold_scl = false;
  run(100 * kBit);
  EXPECT_FALSE(flag(I2C_STR_BB_MASK));
}

TEST_F(I2cBus, RepeatModeGoesOnUntilTheStop) {
  bus.gives = {1, 2, 3, 4};
  use_fifos();
  start(kStart | I2C_MDR_RM_MASK, 1);
  run(30 * kBit);
  set(I2C_MDR, kOn | I2C_MDR_MST_MASK | I2C_MDR_RM_MASK | I2C_MDR_STP_MASK);
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A1+ 01+ 02+ 03- P ");
}

TEST_F(I2cBus, ModuleResetLetsGo) {
  set(I2C_DXR, 0x00);
  start(kSend | I2C_MDR_STP_MASK, 1);
  run(5 * kBit);
  set(I2C_MDR, 0);
  EXPECT_EQ(i2c.next_event(), kNever);
  EXPECT_EQ(get(I2C_STR) & ~I2C_STR_XRDY_MASK, I2C_STR_XSMT_MASK);
}

TEST_F(I2cBus, InterruptsHaveTheirSources) {
  set(I2C_IER, I2C_IER_NACK_MASK | I2C_IER_ARDY_MASK | I2C_IER_SCD_MASK);
  bus.acknowledge = {false};
  set(I2C_DXR, 1);
  start(kSend, 1);
  run(100 * kBit);
  ASSERT_FALSE(services.interrupts.empty());
  EXPECT_EQ(services.interrupts.front().what, VECTOR_I2CINT1A);
  EXPECT_EQ(get(I2C_ISRC), 2);  // NACK before ARDY
  EXPECT_FALSE(flag(I2C_STR_NACK_MASK)) << "cleared by the reading";
  EXPECT_EQ(get(I2C_ISRC), 3);
  EXPECT_TRUE(flag(I2C_STR_ARDY_MASK)) << "this one is not";
  EXPECT_EQ(get(I2C_ISRC), 0);
  services.forget();
  set(I2C_MDR, kOn | I2C_MDR_MST_MASK | I2C_MDR_STP_MASK);
  run(100 * kBit);
  EXPECT_EQ(services.interrupts.size(), 1u);
  EXPECT_EQ(get(I2C_ISRC), 6);
}

TEST_F(I2cBus, FifoInterrupts) {
  use_fifos();
  set(I2C_FFRX, I2C_FFRX_RXFFRST_MASK | I2C_FFRX_RXFFIENA_MASK | 4u);
  for (unsigned n = 0; n < 8; ++n) bus.gives.push_back(n);
  start(kStart | I2C_MDR_STP_MASK, 8);
  run((9 + 3 * 9 + 5) * kBit);
  EXPECT_TRUE(services.interrupts.empty());
  run(9 * kBit);
  ASSERT_EQ(services.interrupts.size(), 1u);
  EXPECT_EQ(services.interrupts.front().what, VECTOR_I2CINT2A);
  EXPECT_NE(get(I2C_FFRX) & I2C_FFRX_RXFFINT_MASK, 0);
}

TEST_F(I2cBus, StandsStillWithoutItsClock) {
  set(I2C_DXR, 0x12);
  start(kSend | I2C_MDR_STP_MASK, 1);
  run(5 * kBit);
  services.clocked = false;
  i2c.clocks_changed(now);
  run(1000 * kBit);
  services.clocked = true;
  i2c.clocks_changed(now);
  run(100 * kBit);
  EXPECT_EQ(bus.seen, "S A0+ 12+ P ");
}

TEST_F(I2cBus, WhatIsNotModelledIsAnError) {
  for (const unsigned bits : {I2C_MDR_XA_MASK, I2C_MDR_FDF_MASK, I2C_MDR_DLB_MASK, 0x0003u}) {
    services.errors.clear();
    set(I2C_MDR, 0);
    set(I2C_MDR, kOn);
    start(kSend | bits, 1);
    EXPECT_EQ(services.errors.size(), 1u) << bits;
  }
}

}  // namespace
}  // namespace stillspin::chip::testing

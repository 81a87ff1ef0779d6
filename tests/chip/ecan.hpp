// The eCAN on a bus that the test plays: registers, mailboxes, frames heard, sent and spoilt.

#ifndef STILLSPIN_TESTS_CHIP_ECAN_HPP
#define STILLSPIN_TESTS_CHIP_ECAN_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "hal/f2808/registers.h"
#include "sim_host/chip/ecan.hpp"
#include "tests/chip/peripheral.hpp"

namespace stillspin::chip::testing {

// 100 MHz / 10 / (1 + 7 + 2): 1 Mbit/s, a bit is 100 ticks.
inline constexpr std::uint32_t kTiming =
    9u << CANBTC_BRPREG_LSB | 6u << CANBTC_TSEG1REG_LSB | 1u << CANBTC_TSEG2REG_LSB;
inline constexpr Tick kCanBit = 100;

class Wire final : public CanLine {
 public:
  void attach(CanNode& n, std::int64_t) override { node = &n; }
  void detach(CanNode&) override { node = nullptr; }
  void changed(CanNode&, std::int64_t) override { ++changes; }
  CanNode* node = nullptr;
  int changes = 0;
};

class ECanTest : public ::testing::Test {
 protected:
  RecordingServices services;
  Wire wire;
  ECan can{services, &wire};
  Tick now = 0;

  void SetUp() override {
    can.reset(0);
    can.set_routed(true, 0);
  }

  std::uint32_t read(std::uint32_t address) { return can.read32(static_cast<std::uint16_t>(address - 0x6000), now); }
  void write(std::uint32_t address, std::uint32_t value) {
    can.write32(static_cast<std::uint16_t>(address - 0x6000), value, now);
  }
  bool status(std::uint32_t mask) { return (read(REG_CANES) & mask) != 0; }
  void pass(Tick ticks) {
    run_until(can, now + ticks);
    now += ticks;
  }
  void configure(std::uint32_t extra = 0) {
    write(REG_CANMC, CANMC_CCR_MASK | CANMC_SCB_MASK | extra);
    write(REG_CANBTC, kTiming);
  }
  void start(std::uint32_t extra = 0) {
    write(REG_CANMC, CANMC_SCB_MASK | extra);
    pass(11 * kCanBit);
  }
  void set_up(unsigned n, std::uint32_t id, bool receives, std::uint32_t control = 0) {
    write(REG_CANME, read(REG_CANME) & ~(1u << n));
    write(REG_CANMSGID(n), id);
    write(REG_CANMSGCTRL(n), control);
    write(REG_CANMD, receives ? read(REG_CANMD) | 1u << n : read(REG_CANMD) & ~(1u << n));
    write(REG_CANME, read(REG_CANME) | 1u << n);
  }
  static constexpr std::uint32_t standard(std::uint32_t id) { return id << CANMSGID_STANDARD_LSB; }

  static CanFrame frame(std::uint32_t id, std::initializer_list<std::uint8_t> data = {}, bool extended = false) {
    CanFrame f;
    f.id = id;
    f.extended = extended;
    f.length = static_cast<std::uint8_t>(data.size());
    std::copy(data.begin(), data.end(), f.data.begin());
    return f;
  }
  void hear(const CanFrame& f) {
    can.can_busy(now, false);
    pass(50 * kCanBit);
    can.can_received(f, now);
    can.can_quiet(now - 8 * kCanBit, now);
    pass(3 * kCanBit);
  }
  /// A frame of the module's own: sent, or ended by an error.
  void transmit() {
    ASSERT_NE(can.can_offer(), nullptr);
    can.can_busy(now, true);
    pass(50 * kCanBit);
    can.can_sent(now);
    can.can_quiet(now - 8 * kCanBit, now);
    pass(3 * kCanBit);
  }
  void fail(CanError error, bool mine) {
    can.can_busy(now, mine);
    pass(30 * kCanBit);
    can.can_failed(error, mine, now);
    can.can_quiet(now - 8 * kCanBit, now);
    pass(3 * kCanBit);
  }
};

}  // namespace stillspin::chip::testing

#endif

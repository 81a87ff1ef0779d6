// The power goes at every octet on the bus and in every write cycle of a save, with everything between the parameters
// and the EEPROM's lines in place: store, driver, I2C module, EEPROM. (tests/firmware/store_power_test.cpp has the same
// on a simpler memory, with many more ways in which a page can be torn.)

#include <gtest/gtest.h>

#include <vector>

#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "hal/hal_clock.h"
#include "hal/hal_nvm.h"
#include "hal/hal_profile.h"
#include "hal/hal_time.h"
#include "sim_host/chip/chip.hpp"
#include "sim_host/devices/eeprom.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/store/store.h"
}

namespace stillspin::bench {
namespace {

using chip::Tick;
using devices::Eeprom;

constexpr Tick kMs = 100'000;
constexpr std::uint16_t kStep = 3000;  // cycles from one step of the background to the next

// A firmware that only looks after its store.
void image() {
  drive_reset();
  hal_clock_init();
  hal_time_init();
  (void)hal_nvm_init();
  store_begin();
  for (;;) {
    hal_profile_step(kStep);
    store_service();
  }
}

class Lines final : public chip::World {
 public:
  explicit Lines(Eeprom& eeprom) : eeprom_(eeprom) {}
  void on_pwm_pins(Tick, int, bool, bool) override {}
  std::uint16_t adc_sample(Tick, int) override { return 0; }
  bool pin_level(Tick, int pin) override { return pin == 33 ? scl_ : pin != 32 || (sda_ && eeprom_.lets_sda_go()); }
  void on_output_pin(Tick, int, bool) override {}
  std::int64_t encoder_edges(Tick) override { return 0; }
  Tick next_call() const override { return chip::kNever; }
  void call(Tick) override {}
  void on_i2c_pins(Tick t, bool sda, bool scl) override {
    sda_ = sda;
    scl_ = scl;
    eeprom_.drive(t, sda, scl);
  }

 private:
  Eeprom& eeprom_;
  bool sda_ = true, scl_ = true;
};

class Supply {
 public:
  explicit Supply(Eeprom& eeprom) : lines_(eeprom), chip_(lines_, image) { run_while_busy(true); }

  store_state_t save() {
    EXPECT_TRUE(store_save());
    run_while_busy(false);
    return store_state();
  }

  Tick now() const { return chip_.now(); }

 private:
  void run_while_busy(bool starting) {
    if (starting) chip_.run_until(10 * kMs);
    for (int n = 0; n < 500 && store_is_busy(); ++n) chip_.run_until(chip_.now() + kMs);
    EXPECT_FALSE(store_is_busy());
  }

  Lines lines_;
  chip::Chip chip_;
};

constexpr std::int32_t kOld = 1111, kNew = 2222;  // of stop_time and synchronism_time, both or none

void set(std::int32_t value) {
  ASSERT_EQ(parameter_set(160, value), SET_OK);
  ASSERT_EQ(parameter_set(163, value % 1000), SET_OK);
}

/// The new set is in force (true) or the old one; nothing else may be.
bool is_new() {
  const bool fresh = parameters.stop_time == kNew;
  EXPECT_EQ(parameters.stop_time, fresh ? kNew : kOld);
  EXPECT_EQ(parameters.synchronism_time, parameters.stop_time % 1000);
  return fresh;
}

class StorePower : public ::testing::Test {
 protected:
  void SetUp() override {
    Eeprom eeprom;
    Supply supply(eeprom);
    set(3333);
    ASSERT_EQ(supply.save(), STORE_SAVED);
    set(kOld);
    ASSERT_EQ(supply.save(), STORE_SAVED);
    before_ = eeprom.memory();
    const std::uint64_t octets = eeprom.octets(), cycles = eeprom.write_cycles();
    ASSERT_EQ(supply.save(), STORE_SAVED);
    octets_ = eeprom.octets() - octets;
    cycles_ = eeprom.write_cycles() - cycles;
  }

  /// A save of the new set with a cut in it, and what a start after that finds.
  template <typename Cut>
  bool save_with(Cut cut) {
    Eeprom eeprom;
    eeprom.memory() = before_;
    {
      Supply supply(eeprom);
      EXPECT_EQ(store_state(), STORE_LOADED);
      set(kNew);
      cut(eeprom);
      EXPECT_EQ(supply.save(), STORE_FAILED);
      EXPECT_FALSE(eeprom.is_on());
    }
    eeprom.power_on();
    Supply again(eeprom);
    const bool renewed = is_new();
    EXPECT_TRUE(store_state() == STORE_LOADED || (store_state() == STORE_OLDER && !renewed)) << store_state();
    return renewed;
  }

  std::vector<std::uint8_t> before_;
  std::uint64_t octets_ = 0, cycles_ = 0;
};

// Every octet of the first pages and of the last, which make a set valid, and every fifth between them: with its
// address a page takes 67 octets, so that the cuts meet every place in one. (PowerCut.AtEveryOctet leaves none out.)
TEST_F(StorePower, CutAtAnyOctet) {
  constexpr std::uint64_t kPages = 3 * 67;
  int renewed = 0;
  const auto is_inside = [&](std::uint64_t at) { return at > kPages && at + kPages < octets_; };
  for (std::uint64_t at = 1; at < octets_; at += is_inside(at) ? 5 : 1) {  // behind the last there is nothing to lose
    renewed += save_with([&](Eeprom& eeprom) { eeprom.cut_after_octets(at); }) ? 1 : 0;
    ASSERT_FALSE(HasFailure()) << "octet " << at << " of " << octets_;
  }
  EXPECT_GT(renewed, 0) << "the last octets read the magic back: it has been written by then";
  EXPECT_LT(renewed, 30);
}

TEST_F(StorePower, CutInEveryWriteCycle) {
  int renewed = 0;
  for (std::uint64_t cycle = 1; cycle <= cycles_; ++cycle) {
    for (const Eeprom::Torn torn : {Eeprom::Torn::kOld, Eeprom::Torn::kNew, Eeprom::Torn::kFirstHalf,
                                    Eeprom::Torn::kLastHalf, Eeprom::Torn::kErased, Eeprom::Torn::kMixed}) {
      renewed +=
          save_with([&](Eeprom& eeprom) { eeprom.cut_in_write_cycle(cycle, torn, std::uint32_t(cycle)); }) ? 1 : 0;
      ASSERT_FALSE(HasFailure()) << "write cycle " << cycle << " of " << cycles_ << " torn " << int(torn);
    }
  }
  EXPECT_GE(renewed, 1) << "the last one writes the magic";
  EXPECT_LE(renewed, 2);
}

}  // namespace
}  // namespace stillspin::bench

// The whole drive with an EEPROM on its board: how the saved parameters come into force, and how long that takes.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "firmware/boot/main.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "hal/f2808/registers.h"
#include "sim_host/bench/board.hpp"
#include "sim_host/bench/virtual_board.hpp"
#include "tests/firmware/slot_of.hpp"

extern "C" {
#include "firmware/api/status.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/store/store.h"
}

namespace stillspin::bench {
namespace {

using devices::Eeprom;

constexpr Tick kMs = 100'000;

/// A board under power; the EEPROM outlives it.
class Powered final : public PeriodListener {
 public:
  explicit Powered(Eeprom* eeprom) : board(plant::PlantConfig::ideal(), *this), chip(board, firmware_main) {
    board.attach(chip);
    if (eeprom != nullptr) board.fit(*eeprom);
    drive_reset();
  }

  void on_period(Tick t) override {
    if (drive.state == DRIVE_BOOT) boot_interrupts = drive.heartbeat;
    if (drive.state != last_state_) changes.emplace_back(t, drive.state);
    last_state_ = drive.state;
  }

  void run_for(Tick ticks) { chip.run_until(chip.now() + ticks); }
  void run_while_busy() {
    for (int n = 0; n < 2000 && store_is_busy(); ++n) run_for(kMs / 2);
  }
  /// When a state was entered, ms after power-on; -1 if never.
  double entered(drive_state_t state) const {
    for (const auto& [t, s] : changes) {
      if (s == state) return double(t) / double(kMs);
    }
    return -1.0;
  }

  std::vector<std::pair<Tick, drive_state_t>> changes;
  int boot_interrupts = 0;  // that BOOT has seen
  Board board;
  chip::Chip chip;

 private:
  drive_state_t last_state_ = DRIVE_BOOT;
};

store_state_t save(Powered& drive_under_test) {
  EXPECT_TRUE(store_save());
  drive_under_test.run_while_busy();
  return store_state();
}

double ready_without_a_memory() {
  Powered bare(nullptr);
  bare.run_for(100 * kMs);
  return bare.entered(DRIVE_READY);
}

TEST(BoardStore, WithoutAMemoryNothingIsLate) {
  Powered bare(nullptr);
  bare.run_for(100 * kMs);
  EXPECT_EQ(drive.state, DRIVE_READY);
  EXPECT_EQ(store_state(), STORE_ABSENT);
  EXPECT_EQ(bare.boot_interrupts, 0) << "the first control interrupt leaves BOOT";
  const chip::Statistics& s = bare.chip.statistics();
  EXPECT_EQ(s.protected_writes_lost + s.gated_accesses + s.unmodelled_accesses, 0u);
}

TEST(BoardStore, ANewMemoryCostsNoTimeWorthMentioning) {
  const double bare = ready_without_a_memory();
  Eeprom eeprom;
  Powered fitted(&eeprom);
  fitted.run_for(100 * kMs);
  EXPECT_EQ(store_state(), STORE_EMPTY);
  EXPECT_NEAR(fitted.entered(DRIVE_READY), bare, 1.5);
  EXPECT_EQ(eeprom.write_cycles(), 0u);
}

TEST(BoardStore, SavedParametersAreInForceBeforeTheDriveIsReady) {
  const double bare = ready_without_a_memory();
  Eeprom eeprom;
  {
    Powered first(&eeprom);
    first.run_for(60 * kMs);
    ASSERT_EQ(parameter_set(8, 12 << 20), SET_OK);
    ASSERT_EQ(parameter_set(20, 117965), SET_OK);  // dead_time 1.8 us: the PWM must get it
    const Tick begin = first.chip.now();
    ASSERT_EQ(save(first), STORE_SAVED);
    RecordProperty("save_ms", int((first.chip.now() - begin) / kMs));
    EXPECT_LT(first.chip.now() - begin, 250 * kMs);
    EXPECT_EQ(first.chip.statistics().resets, 0u);
  }
  Powered again(&eeprom);
  again.run_for(200 * kMs);
  EXPECT_EQ(store_state(), STORE_LOADED);
  EXPECT_EQ(drive.state, DRIVE_READY);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
  EXPECT_EQ(drive.config.dead_time.turn_on_ticks, 210);
  EXPECT_EQ(again.chip.inspect(EPWM_BASE(1) + EPWM_DBRED), 180);
  // 22.5 us an octet, and what the steps in the background add to it, up to a third; 5 ms pass while the converter
  // powers up
  const double late = again.entered(DRIVE_READY) - bare;
  RecordProperty("load_us", int(1000 * late));
  const double reading = 0.0225 * 8 * parameter_count();
  EXPECT_GT(late, reading - 5.0);
  EXPECT_LT(late, reading * 4.0 / 3.0);
}

// The usual rate until the saved one is known.
TEST(BoardStore, ASavedBaudRateIsInForceAsSoonAsItIsRead) {
  const auto rate = [](Powered& board) {
    const unsigned divisor =
        board.chip.inspect(SCI_BASE(1) + SCI_HBAUD) << 8 | board.chip.inspect(SCI_BASE(1) + SCI_LBAUD);
    return 50e6 / 8.0 / (divisor + 1.0);  // the low-speed clock
  };
  Eeprom eeprom;
  {
    Powered first(&eeprom);
    first.run_for(60 * kMs);
    EXPECT_NEAR(rate(first), 115200.0, 0.02 * 115200.0);
    ASSERT_EQ(parameter_set(200, 57600), SET_OK);
    ASSERT_EQ(save(first), STORE_SAVED);
  }
  Powered again(&eeprom);
  again.run_for(10 * kMs);
  EXPECT_NEAR(rate(again), 115200.0, 0.02 * 115200.0) << "still reading";
  again.run_for(100 * kMs);
  EXPECT_NEAR(rate(again), 57600.0, 0.01 * 57600.0);
}

// So little is read before the converter is up: it is in force all the same, and the drive waits for its configuration.
TEST(BoardStore, AMemoryThatIsReadAtOnceIsInForce) {
  Eeprom eeprom;
  const std::vector<std::uint16_t> slot = test::slot_of(SLOT_VERSION, 1, {{20, 16, 117965}});  // dead_time 1.8 us
  std::copy(slot.begin(), slot.end(), eeprom.memory().begin());
  Powered board(&eeprom);
  board.run_for(100 * kMs);
  EXPECT_EQ(store_state(), STORE_MIGRATED);
  EXPECT_EQ(drive.state, DRIVE_READY);
  EXPECT_FALSE(feature_status.loading);
  EXPECT_EQ(board.chip.inspect(EPWM_BASE(1) + EPWM_DBRED), 180);
}

TEST(BoardStore, TheMemoryHangsAtPowerOn) {
  Eeprom eeprom;
  {
    Powered first(&eeprom);
    first.run_for(60 * kMs);
    ASSERT_EQ(parameter_set(8, 12 << 20), SET_OK);
    ASSERT_EQ(save(first), STORE_SAVED);
  }
  eeprom.hold_sda(5);
  {
    Powered again(&eeprom);
    again.run_for(200 * kMs);
    EXPECT_EQ(store_state(), STORE_LOADED);
    EXPECT_EQ(parameters.current_limit, 12 << 20);
  }
  eeprom.hold_sda(1'000'000);
  Powered hung(&eeprom);
  hung.run_for(200 * kMs);
  EXPECT_EQ(store_state(), STORE_ABSENT);
  EXPECT_EQ(drive.state, DRIVE_READY) << "with the defaults";
  EXPECT_EQ(parameters.current_limit, 14 << 20);
}

// The power of the whole board goes at any time while it saves; the EEPROM keeps what it has.
TEST(BoardStore, ThePowerGoesWhileItSaves) {
  Eeprom eeprom;
  Powered first(&eeprom);
  first.run_for(60 * kMs);
  ASSERT_EQ(parameter_set(8, 12 << 20), SET_OK);
  ASSERT_EQ(save(first), STORE_SAVED);
  const std::vector<std::uint8_t> saved = eeprom.memory();
  const Tick begin = first.chip.now();
  ASSERT_EQ(save(first), STORE_SAVED);
  const Tick whole = first.chip.now() - begin;  // of one beside what the memory has already
  int renewed = 0;
  int kept = 0;
  for (Tick at = kMs; at < whole + 20 * kMs; at += 7 * kMs + 317) {
    Eeprom copy;
    copy.memory() = saved;
    {
      Powered second(&copy);
      second.run_for(200 * kMs);
      ASSERT_EQ(parameter_set(8, 13 << 20), SET_OK);
      ASSERT_TRUE(store_save());
      second.run_for(at);
      copy.power_off(second.chip.now(), Eeprom::Torn::kMixed, std::uint32_t(at));
    }
    copy.power_on();
    Powered third(&copy);
    third.run_for(200 * kMs);
    const bool is_new = parameters.current_limit == 13 << 20;
    ASSERT_TRUE(is_new || parameters.current_limit == 12 << 20) << at;
    ASSERT_TRUE(store_state() == STORE_LOADED || (store_state() == STORE_OLDER && !is_new)) << at;
    renewed += is_new ? 1 : 0;
    kept += is_new ? 0 : 1;
  }
  EXPECT_GT(renewed, 0);
  EXPECT_GT(kept, 0);
}

// Saving costs the control nothing: its interrupts come as they did.
TEST(BoardStore, ControlIsNotDisturbedByASave) {
  Eeprom eeprom;
  Powered board(&eeprom);
  board.run_for(60 * kMs);
  const std::uint16_t before = drive.heartbeat;
  const Tick begin = board.chip.now();
  ASSERT_EQ(save(board), STORE_SAVED);
  const auto periods = static_cast<std::uint16_t>((board.chip.now() - begin) / kPeriod);
  EXPECT_NEAR(static_cast<std::uint16_t>(drive.heartbeat - before), periods, 1);
  EXPECT_EQ(drive.modulation.overrun, 0);
}

TEST(VirtualBoardStore, TheEepromOutlivesTheBoard) {
  std::vector<std::uint8_t> kept;
  {
    VirtualBoard desk(BoardRequest{});
    EXPECT_EQ(desk.eeprom(), std::vector<std::uint8_t>(Eeprom::kSize, 0xFF));
    desk.advance(60 * kMs);
    EXPECT_THROW(desk.set_eeprom(desk.eeprom()), std::logic_error);
    ASSERT_EQ(parameter_set(8, 12 << 20), SET_OK);
    ASSERT_TRUE(store_save());
    desk.advance(200 * kMs);
    EXPECT_EQ(store_state(), STORE_SAVED);
    kept = desk.eeprom();
  }
  VirtualBoard again(BoardRequest{});
  EXPECT_THROW(again.set_eeprom(std::vector<std::uint8_t>(100)), std::invalid_argument);
  again.set_eeprom(kept);
  again.advance(100 * kMs);
  EXPECT_EQ(store_state(), STORE_LOADED);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
}

}  // namespace
}  // namespace stillspin::bench

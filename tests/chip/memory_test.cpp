// RAM, the flash's cells, code security, and the stand-in for TI's flash library.

#include "sim_host/chip/memory.hpp"

#include <gtest/gtest.h>

#include "hal/f2808/flash_library.h"
#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;
using stillspin::chip::FlashArray;
using stillspin::chip::kErased;
using stillspin::chip::kFlashStart;
using stillspin::chip::kPasswords;
using stillspin::chip::kSectorWords;
using stillspin::chip::Memory;

void open(Memory& memory) {
  for (std::uint32_t n = 0; n < 8; ++n) (void)memory.read(kPasswords + n);
}

TEST(Memory, RamHasItsMappingsAndHolesAreNone) {
  Memory memory;
  open(memory);
  EXPECT_TRUE(memory.write(0x3FA005, 0x1234));
  EXPECT_EQ(memory.read(0x00A005), 0x1234) << "H0 has two addresses";
  EXPECT_TRUE(memory.write(0x0007FF, 7));
  EXPECT_TRUE(memory.write(0x008000, 8));
  EXPECT_EQ(memory.read(0x0007FF), 7);
  EXPECT_EQ(memory.read(0x3F8000), 8);
  EXPECT_FALSE(memory.write(0x00C000, 1));
  EXPECT_FALSE(memory.read(0x3E7FFF).has_value());
  EXPECT_EQ(memory.read(kFlashStart), kErased);
  EXPECT_EQ(memory.read(0x3D7800), kErased) << "OTP";
}

TEST(Memory, PlainWriteDoesNotReachTheFlash) {
  Memory memory;
  open(memory);
  EXPECT_TRUE(memory.write(kFlashStart, 0));
  EXPECT_EQ(memory.read(kFlashStart), kErased);
}

TEST(Memory, ProgrammingClearsBitsAndErasingSetsASectorsWords) {
  FlashArray flash;
  flash.finish_program(kFlashStart, 0x0FF0);
  flash.finish_program(kFlashStart, 0xF0F0);
  EXPECT_EQ(flash.read(kFlashStart), 0x00F0);
  flash.finish_program(kFlashStart + kSectorWords, 0);
  flash.finish_erase(3);
  EXPECT_EQ(flash.read(kFlashStart), kErased) << "sector D";
  EXPECT_EQ(flash.read(kFlashStart + kSectorWords), 0) << "sector C is another one";
  EXPECT_EQ(FlashArray::sector_start(0), 0x3F4000u);
}

TEST(Memory, WordCutOffWhileProgrammedHasLostOnlyBitsThatItWasToLose) {
  FlashArray flash;
  for (std::uint32_t k = 0; k < 64; ++k) {
    flash.begin_program(kFlashStart + k, 0x00FF);
    EXPECT_EQ(flash.read(kFlashStart + k) & 0x00FF, 0x00FF);
  }
}

TEST(Security, LocksUntilThePasswordsHaveBeenRead) {
  Memory memory;
  memory.flash().words()[0] = 0x1111;
  EXPECT_TRUE(memory.locked());
  EXPECT_EQ(memory.read(kFlashStart), 0);
  EXPECT_TRUE(memory.write(0x8000, 5)) << "there is memory, but the write is lost";
  open(memory);
  EXPECT_FALSE(memory.locked());
  EXPECT_EQ(memory.read(kFlashStart), 0x1111);
  EXPECT_EQ(memory.read(0x8000), 0);
  memory.reset();
  EXPECT_TRUE(memory.locked());
}

TEST(Security, OpensWithTheKeyAndNeverWithZeros) {
  Memory memory;
  for (std::uint32_t n = 0; n < 8; ++n) memory.flash().finish_program(kPasswords + n, static_cast<std::uint16_t>(n));
  open(memory);
  EXPECT_TRUE(memory.locked());
  for (std::uint32_t n = 0; n < 8; ++n) memory.write_security(REG_KEY(n), static_cast<std::uint16_t>(n));
  EXPECT_TRUE(memory.locked()) << "the passwords have to be read once more";
  open(memory);
  EXPECT_FALSE(memory.locked());
  memory.write_security(REG_CSMSCR, CSMSCR_FORCESEC_MASK);
  EXPECT_TRUE(memory.locked());
  for (std::uint32_t n = 0; n < 8; ++n) memory.flash().finish_program(kPasswords + n, 0);
  open(memory);
  EXPECT_TRUE(memory.locked()) << "all zeros lock for ever";
}

// ---- the library, from firmware --------------------------------------------------------------------------

std::uint16_t results[4];
flash_library_status_t at;
std::uint16_t source[4];

std::uint16_t* flash_pointer(std::uint32_t address) {
  return reinterpret_cast<std::uint16_t*>(static_cast<std::uintptr_t>(address));  // never followed
}

void open_chip() {
  for (std::uint32_t n = 0; n < 8; ++n) (void)target_read16(REG_PSWD(n));
}

void set_up_library() {
  start_clock();
  write_protected(REG_FBANKWAIT, 0x0303);
  Flash_CPUScaleFactor = FLASH_LIBRARY_SCALE(100u);
}

class FlashLibrary : public ::testing::Test {
 protected:
  RecordingWorld world;
  void run(Chip::Firmware firmware, Tick until) {
    chip = std::make_unique<Chip>(world, firmware);
    if (prepare) prepare(chip->memory().flash());
    chip->run_until(until);
  }
  std::function<void(FlashArray&)> prepare;
  std::unique_ptr<Chip> chip;
};

TEST_F(FlashLibrary, ErasesProgramsAndRefuses) {
  prepare = [](FlashArray& flash) { flash.finish_program(0x3EC003, 0); };
  run(
      [] {
        set_up_library();
        source[0] = 0x1234;
        source[1] = 0x00FF;
        results[0] = Flash2808_Program(flash_pointer(0x3EC003), source, 1, &at);
        open_chip();
        results[1] = Flash2808_Program(flash_pointer(0x3EC003), source, 1, &at);
        results[2] = Flash2808_Erase(FLASH_LIBRARY_SECTOR(2), &at);
        results[3] = Flash2808_Program(flash_pointer(0x3EC003), source, 2, &at);
        sleep_for_ever();
      },
      FlashArray::kEraseTime + 10'000'000);
  EXPECT_EQ(results[0], FLASH_LIBRARY_LOCKED);
  EXPECT_EQ(results[1], FLASH_LIBRARY_ZERO_BIT);
  EXPECT_EQ(results[2], FLASH_LIBRARY_DONE);
  EXPECT_EQ(results[3], FLASH_LIBRARY_DONE);
  EXPECT_EQ(chip->inspect(0x3EC003), 0x1234);
  EXPECT_EQ(chip->inspect(0x3EC004), 0x00FF);
}

TEST_F(FlashLibrary, NoticesABadAddressAndNoSector) {
  run(
      [] {
        set_up_library();
        open_chip();
        results[0] = Flash2808_Erase(0, &at);
        results[1] = Flash2808_Program(flash_pointer(0x3E7FFF), source, 1, &at);
        results[2] = Flash2808_Program(flash_pointer(0x3F7FFF), source, 2, &at);
        sleep_for_ever();
      },
      10'000'000);
  EXPECT_EQ(results[0], FLASH_LIBRARY_NO_SECTOR);
  EXPECT_EQ(results[1], FLASH_LIBRARY_ADDRESS);
  EXPECT_EQ(results[2], FLASH_LIBRARY_ADDRESS);
}

TEST_F(FlashLibrary, SectorThatLosesItsPowerHoldsSomething) {
  run(
      [] {
        set_up_library();
        open_chip();
        (void)Flash2808_Erase(FLASH_LIBRARY_SECTOR(1), &at);
      },
      FlashArray::kEraseTime / 2);
  unsigned neither = 0;
  for (std::uint32_t k = 0; k < kSectorWords; ++k) neither += chip->inspect(0x3F0000 + k) != kErased ? 1u : 0u;
  EXPECT_GT(neither, kSectorWords / 2);
  EXPECT_EQ(chip->inspect(0x3EFFFF), kErased);
  EXPECT_EQ(chip->inspect(0x3F4000), kErased);
}

TEST_F(FlashLibrary, EndsTheRunWhenItsDutiesAreNotDone) {
  const auto wrong_scale = [] {
    set_up_library();
    open_chip();
    Flash_CPUScaleFactor = FLASH_LIBRARY_SCALE(50u);
    (void)Flash2808_Erase(FLASH_LIBRARY_SECTOR(1), &at);
  };
  EXPECT_THROW(run(wrong_scale, 20'000'000), std::runtime_error);
  const auto watchdog_locked = [] {
    set_up_library();
    open_chip();
    write_protected(REG_SCSR, SCSR_WDOVERRIDE_MASK);
    (void)Flash2808_Erase(FLASH_LIBRARY_SECTOR(1), &at);
  };
  EXPECT_THROW(run(watchdog_locked, 20'000'000), std::runtime_error);
}

}  // namespace

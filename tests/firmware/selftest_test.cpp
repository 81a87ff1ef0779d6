// The self-test at power-up, on a board that the test describes.

#include "firmware/board/selftest.h"

#include <gtest/gtest.h>

#include <string>

#include "firmware/board/functions.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"
#include "hal/hal_selftest.h"
#include "tests/firmware/fake_hal.hpp"

namespace stillspin::test {
namespace {

constexpr std::uint32_t kService = 11 * HAL_SELFTEST_WATCHDOG_CYCLES - 5000;  // cycles between two services

class SelfTest : public ::testing::Test {
 protected:
  void SetUp() override {
    board = FakeBoard{};
    drive_reset();
  }

  static void whole_ram() {
    for (unsigned n = 0; n < HAL_SELFTEST_PAIRS; ++n) (void)selftest_service();
  }

  static void services(int count, std::uint32_t cycles) {
    for (int n = 0; n < count; ++n) selftest_count(cycles);
  }

  static void put_pair(std::uint32_t address, std::uint32_t value) {
    board.flash[address] = static_cast<std::uint16_t>(value & 0xFFFF);
    board.flash[address + 1] = static_cast<std::uint16_t>(value >> 16);
  }

  // The identity of an image that ends before `end`, with `sum` as its check sum.
  static void put_identity(std::uint32_t end, std::uint32_t sum) {
    board.flash[HAL_FLASH_IMAGE_IDENTITY] = HAL_IMAGE_MARK;
    put_pair(HAL_FLASH_IMAGE_IDENTITY + HAL_IMAGE_SUM_END, end);
    put_pair(HAL_FLASH_IMAGE_IDENTITY + HAL_IMAGE_SUM, sum);
  }

  static std::string words() {
    std::uint16_t octets[400];
    octet_writer_t w = octet_writer(octets, 400);
    selftest_line.put(&w);
    return {octets, octets + w.count};
  }
};

TEST_F(SelfTest, PassesOnAGoodBoard) {
  selftest_look();
  EXPECT_EQ(words(), "under way; flash not tested, the image has no check sum");
  whole_ram();
  services(100, kService);
  EXPECT_EQ(selftest_service(), FAULT_NONE);
  EXPECT_EQ(words(), "passed; flash not tested, the image has no check sum");
}

// It is over when all of it is: neither the RAM nor the clock alone.
TEST_F(SelfTest, SaysThatTheWatchdogHasResetTheChip) {
  EXPECT_EQ(words().find("watchdog"), std::string::npos) << words();
  board.reset_by_watchdog = true;
  EXPECT_NE(words().find("; reset by the watchdog"), std::string::npos) << words();
  EXPECT_EQ(selftest_service(), FAULT_NONE) << "it is told and no fault";
}

TEST_F(SelfTest, IsUnderWayUntilEachPartIsThrough) {
  for (const bool ram_first : {true, false}) {
    drive_reset();
    selftest_look();
    ram_first ? whole_ram() : services(100, kService);
    EXPECT_EQ(words().find("under way"), 0u) << words();
    ram_first ? services(100, kService) : whole_ram();
    EXPECT_EQ(words().find("passed"), 0u) << words();
  }
}

TEST_F(SelfTest, FindsTheFirstAndTheLastPairOfRam) {
  for (const int pair : {0, int{HAL_SELFTEST_PAIRS} - 1}) {
    board.bad_pair = pair;
    drive_reset();
    whole_ram();
    EXPECT_EQ(selftest.failed, SELFTEST_RAM) << pair;
    EXPECT_EQ(selftest_service(), FAULT_SELF_TEST);
    EXPECT_EQ(interlock_refusal(), FAULT_SELF_TEST);
  }
}

TEST_F(SelfTest, SaysWhatIsWrong) {
  board.bad_pair = 3;
  board.gate_pins_off = false;
  selftest_look();
  whole_ram();
  const std::string said = words();
  EXPECT_NE(said.find("RAM"), std::string::npos) << said;
  EXPECT_NE(said.find("gate"), std::string::npos) << said;
  services(100, kService);
  EXPECT_EQ(words().find("passed"), std::string::npos) << words();
  EXPECT_EQ(words().find("under way"), std::string::npos) << words();
}

TEST_F(SelfTest, DoesNotTouchTheRamWhileTheDriveRuns) {
  inside::be_in(DRIVE_RUN);
  whole_ram();
  EXPECT_EQ(selftest.pair, 0);
}

// A PLL that multiplies by 4 or 6 and not by 5, and a crystal of a tenth.
TEST_F(SelfTest, FindsAClockThatIsWrong) {
  for (const double factor : {0.8, 1.2, 10.0}) {
    drive_reset();
    services(99, static_cast<std::uint32_t>(kService * factor));
    EXPECT_EQ(selftest.failed, 0) << "not before it has counted for long enough";
    services(1, static_cast<std::uint32_t>(kService * factor));
    EXPECT_EQ(selftest.failed, SELFTEST_CLOCK) << factor;
  }
  for (const double factor : {0.97, 1.0, 1.03}) {
    drive_reset();
    services(100, static_cast<std::uint32_t>(kService * factor));
    EXPECT_EQ(selftest.failed, 0) << factor;
  }
}

// Half a count is lost at each service on average; what is left may be an eighth off.
TEST_F(SelfTest, TheClockMayBeAnEighthOff) {
  for (const auto& [expected, right] : {std::pair{885, false}, {893, true}, {1138, true}, {1148, false}}) {
    drive_reset();
    services(100, static_cast<std::uint32_t>((expected + 50) * HAL_SELFTEST_WATCHDOG_CYCLES / 100 + 1));
    EXPECT_EQ(selftest.failed == 0, right) << expected;
  }
}

TEST_F(SelfTest, LooksAtGatePinsAlways) {
  board.gate_pins_off = false;
  selftest_look();
  EXPECT_EQ(selftest_service(), FAULT_SELF_TEST);
  EXPECT_EQ(selftest.failed, SELFTEST_GATE_PINS);
}

TEST_F(SelfTest, MissesNothingThatIsNotWired) {
  board.reference = 0;
  board.gates_pass = true;
  selftest_look();
  EXPECT_EQ(selftest_service(), FAULT_NONE);
  parameters.reference_input = 1;
  EXPECT_EQ(selftest_service(), FAULT_SELF_TEST);
  EXPECT_EQ(selftest.failed, SELFTEST_CONVERTER);
  parameters.gate_feedback = 1;
  (void)selftest_service();
  EXPECT_EQ(selftest.failed, SELFTEST_CONVERTER | SELFTEST_GATE_ENABLE);
}

// Where they are wired, ground and the reference are read as what they are within 2 % of the range.
TEST_F(SelfTest, MeasuresTheReferenceThatIsWired) {
  struct Case {
    int ground, reference;
    bool good;
  };
  for (const Case& c : {Case{0, 2048, true},
                        {0, 2048 + 81, true},
                        {0, 2048 - 81, true},
                        {0, 2048 + 82, false},
                        {0, 2048 - 82, false},
                        {81, 2048, true},
                        {82, 2048, false}}) {
    board.ground = static_cast<std::uint16_t>(c.ground);
    board.reference = static_cast<std::uint16_t>(c.reference);
    drive_reset();
    parameters.reference_input = 1;
    selftest_look();
    EXPECT_EQ(selftest_service(), c.good ? FAULT_NONE : FAULT_SELF_TEST) << c.ground << ", " << c.reference;
    EXPECT_EQ(selftest.failed, c.good ? 0 : SELFTEST_CONVERTER);
  }
}

// The sum is that of Python's zlib.crc32 over the same words, low octet first, with four octets 0xFF in its own place.
TEST_F(SelfTest, ComparesTheFlashWithTheSumOfTheImage) {
  for (std::uint32_t k = 0; k < 0x5000; ++k) {
    board.flash[HAL_FLASH_START + k] = static_cast<std::uint16_t>((k * 40503u + 12345u) & 0xFFFF);
  }
  put_identity(HAL_FLASH_START + 0x5000, 0xCE034865uL);
  drive_reset();
  selftest_look();
  services(100, kService);
  EXPECT_EQ(words(), "under way");
  while (selftest.pair < HAL_SELFTEST_PAIRS) (void)selftest_service();
  EXPECT_EQ(words(), "under way") << "the flash takes longer than the RAM";
  whole_ram();
  EXPECT_EQ(words(), "passed");
  for (const std::uint32_t place : {0x0u, 0x1Fu, 0x2Eu, 0x4FFFu}) {
    board.flash[HAL_FLASH_START + place] ^= 0x0400;
    drive_reset();
    selftest_look();
    whole_ram();
    EXPECT_EQ(selftest.failed, SELFTEST_FLASH) << place;
    EXPECT_EQ(selftest_service(), FAULT_SELF_TEST) << place;
    board.flash[HAL_FLASH_START + place] ^= 0x0400;
  }
  board.flash[HAL_FLASH_START + 0x5000] = 0;
  drive_reset();
  selftest_look();
  whole_ram();
  EXPECT_EQ(selftest.failed, 0) << "behind the image anything may lie";
}

// An image may end anywhere: what comes behind it is not taken along.
TEST_F(SelfTest, TheSumEndsWithTheImage) {
  for (std::uint32_t k = 0; k < 0x5100; ++k) {
    board.flash[HAL_FLASH_START + k] = static_cast<std::uint16_t>((k * 40503u + 12345u) & 0xFFFF);
  }
  put_identity(HAL_FLASH_START + 0x5005, 0xE0A8CC14uL);
  drive_reset();
  selftest_look();
  whole_ram();
  services(100, kService);
  EXPECT_EQ(words(), "passed");
}

TEST_F(SelfTest, TestsNoFlashByASumThatCannotBe) {
  for (const std::uint32_t end : {0xFFFFFFFFuL, 0uL, HAL_FLASH_IMAGE_IDENTITY + 13uL, HAL_FLASH_CSM_RESERVED + 1uL}) {
    put_identity(static_cast<std::uint32_t>(end), 0);
    drive_reset();
    selftest_look();
    whole_ram();
    EXPECT_EQ(selftest_service(), FAULT_NONE) << end;
    EXPECT_NE(words().find("no check sum"), std::string::npos) << end;
  }
  put_identity(HAL_FLASH_START + 0x100, 0);
  board.flash[HAL_FLASH_IMAGE_IDENTITY] = 0;  // an image without its mark
  drive_reset();
  selftest_look();
  whole_ram();
  EXPECT_EQ(selftest_service(), FAULT_NONE);
}

}  // namespace
}  // namespace stillspin::test

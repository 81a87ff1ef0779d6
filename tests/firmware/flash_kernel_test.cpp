// The flash kernel's requests on a flash that can fail: what is done in which order, and what is told.

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "firmware/base/crc.h"
#include "firmware/flash_kernel/kernel.h"
#include "firmware/flash_kernel/update.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"

namespace {

constexpr std::uint16_t kB = 1, kC = 2, kD = 3;
constexpr std::uint16_t kReadsOtherwise = 40;  // the flash library's own code for such a word
constexpr std::uint32_t kBStart = 0x3F0000, kDStart = 0x3E8000;
constexpr std::uint32_t kLast = HAL_FLASH_SECTOR_WORDS - 1;  // word of a sector

// A flash that does what it is told, unless a test says otherwise; and a list of what it was told.
struct FakeFlash {
  std::vector<std::uint16_t> words = std::vector<std::uint16_t>(HAL_FLASH_END - HAL_FLASH_START, HAL_FLASH_ERASED);
  std::vector<std::string> told;
  bool locked = false;
  hal_flash_result_t erase_gives = HAL_FLASH_DONE, program_gives = HAL_FLASH_DONE;
  bool programs_nothing = false;
  std::uint32_t stays_low = 0;  // a word that an erase does not reach
  hal_flash_failure_t failure{22, 0x3E8123};

  std::uint16_t& at(std::uint32_t address) { return words[address - HAL_FLASH_START]; }
};
FakeFlash flash;

class FlashKernel : public ::testing::Test {
 protected:
  void SetUp() override { flash = FakeFlash{}; }

  void seal() { flash.at(HAL_FLASH_IMAGE_IDENTITY) = HAL_IMAGE_MARK; }

  static std::uint32_t crc_with_mark() {
    std::uint32_t sum = CRC32_BEGIN;
    for (std::uint32_t a = HAL_FLASH_START; a < HAL_FLASH_UPDATE_END; a++) {
      const std::uint16_t word = a == HAL_FLASH_IMAGE_IDENTITY ? HAL_IMAGE_MARK : flash.at(a);
      sum = crc32_add(crc32_add(sum, word & 0xFFu), word >> 8);
    }
    return crc32_end(sum);
  }

  static std::vector<std::uint16_t> ask(std::vector<std::uint16_t> request) {
    std::vector<std::uint16_t> answer(RECORD_MAX);
    answer.resize(kernel_answer(request.data(), static_cast<std::uint16_t>(request.size()), answer.data()));
    return answer;
  }
  static std::uint16_t status(const std::vector<std::uint16_t>& request) { return ask(request).at(2); }
};

using Told = std::vector<std::string>;

TEST_F(FlashKernel, TakesTheMarkAwayBeforeItErases) {
  seal();
  EXPECT_EQ(update_erase(kB), KERNEL_OK);
  EXPECT_EQ(flash.told, (Told{"program 3E8020 0000", "erase 1"}));
}

TEST_F(FlashKernel, TakesAwayAlsoWhatAPowerFailureLeftOfAMark) {
  flash.at(HAL_FLASH_IMAGE_IDENTITY) = 0xDAA7;
  EXPECT_EQ(update_erase(kD), KERNEL_OK);
  EXPECT_EQ(flash.told, (Told{"program 3E8020 0000", "erase 3"}));
}

TEST_F(FlashKernel, LeavesAMarkThatIsGone) {
  flash.at(HAL_FLASH_IMAGE_IDENTITY) = 0;
  EXPECT_EQ(update_erase(kB), KERNEL_OK);
  flash.at(HAL_FLASH_IMAGE_IDENTITY) = HAL_FLASH_ERASED;
  EXPECT_EQ(update_erase(kB), KERNEL_OK);
  EXPECT_EQ(flash.told, (Told{"erase 1", "erase 1"}));
}

TEST_F(FlashKernel, ErasesNothingWhenTheMarkDoesNotGo) {
  seal();
  flash.programs_nothing = true;
  EXPECT_EQ(update_erase(kB), KERNEL_FLASH);
  EXPECT_EQ(update_failed_at(), HAL_FLASH_IMAGE_IDENTITY);
  flash.program_gives = HAL_FLASH_FAILED;
  EXPECT_EQ(update_erase(kB), KERNEL_FLASH);
  EXPECT_EQ(update_failed_code(), 22);
  for (const auto& words : flash.told) EXPECT_EQ(words.find("erase"), std::string::npos);
}

TEST_F(FlashKernel, RefusesSectorAAndLockedChipsUntouched) {
  seal();
  for (const std::uint16_t sector : {0, 4, 255}) EXPECT_EQ(update_erase(sector), KERNEL_RANGE);
  flash.locked = true;
  const std::uint16_t word = 1;
  EXPECT_EQ(update_erase(kB), KERNEL_LOCKED);
  EXPECT_EQ(update_write(kBStart, &word, 1), KERNEL_LOCKED);
  EXPECT_EQ(update_seal(crc_with_mark()), KERNEL_LOCKED);
  EXPECT_TRUE(flash.told.empty());
}

TEST_F(FlashKernel, TellsWhatAnEraseDidNotDo) {
  flash.erase_gives = HAL_FLASH_FAILED;
  EXPECT_EQ(ask({KERNEL_ERASE, 9, kB}),
            (std::vector<std::uint16_t>{KERNEL_ERASE | 0x80, 9, KERNEL_FLASH, 22, 0, 0x23, 0x81, 0x3E, 0}));
  flash.erase_gives = HAL_FLASH_LOCKED;
  EXPECT_EQ(update_erase(kB), KERNEL_LOCKED);
  flash.erase_gives = HAL_FLASH_OUTSIDE;
  EXPECT_EQ(update_erase(kB), KERNEL_RANGE);
}

TEST_F(FlashKernel, FindsAWordThatAnEraseDidNotReach) {
  for (const std::uint16_t sector : {kB, kC, kD}) {
    const std::uint32_t start = kBStart - (sector - kB) * HAL_FLASH_SECTOR_WORDS;
    for (const std::uint32_t word : {start, start + kLast}) {
      flash.stays_low = word;
      EXPECT_EQ(update_erase(sector), KERNEL_FLASH);
      EXPECT_EQ(update_failed_at(), word);
      EXPECT_EQ(update_failed_code(), kReadsOtherwise);
    }
  }
}

TEST_F(FlashKernel, AnEraseLooksAtItsOwnSectorOnly) {
  flash.at(kBStart) = flash.at(kBStart - 1) = flash.at(kBStart - HAL_FLASH_SECTOR_WORDS - 1) = 0x1234;
  EXPECT_EQ(update_erase(kC), KERNEL_OK);
  EXPECT_EQ(flash.at(kBStart), 0x1234);
}

TEST_F(FlashKernel, LooksAtEveryWordOfAWrite) {
  const std::uint16_t words[] = {1, 2, 3};
  flash.at(kDStart) = 1;
  flash.at(kDStart + 1) = 2;
  flash.programs_nothing = true;
  EXPECT_EQ(update_write(kDStart, words, 3), KERNEL_FLASH);
  EXPECT_EQ(update_failed_at(), kDStart + 2);
  flash.programs_nothing = false;
  EXPECT_EQ(update_write(kDStart, words, 3), KERNEL_OK);
  EXPECT_EQ(flash.at(kDStart + 2), 3) << "also when it begins with what is there";
}

TEST_F(FlashKernel, WritesWhatDiffersAndReadsItBack) {
  const std::uint16_t words[] = {1, 2, 3};
  EXPECT_EQ(update_write(kDStart, words, 3), KERNEL_OK);
  EXPECT_EQ(update_write(kDStart, words, 3), KERNEL_OK);
  EXPECT_EQ(flash.told, (Told{"program 3E8000 0001 0002 0003"})) << "once";
  flash.programs_nothing = true;
  EXPECT_EQ(update_write(kDStart + 1, words, 3), KERNEL_FLASH);
  EXPECT_EQ(update_failed_at(), kDStart + 1);
  EXPECT_EQ(update_failed_code(), kReadsOtherwise);
  flash.program_gives = HAL_FLASH_FAILED;
  EXPECT_EQ(update_write(kDStart + 1, words, 3), KERNEL_FLASH);
  EXPECT_EQ(update_failed_at(), 0x3E8123u);
}

TEST_F(FlashKernel, WritesUpToTheEdgesOfItsSectorsAndNoFurther) {
  const std::uint16_t words[] = {1, 2};
  EXPECT_EQ(update_write(0x3F3FFE, words, 2), KERNEL_OK);
  EXPECT_EQ(update_write(0x3F3FFF, words, 2), KERNEL_RANGE);
  EXPECT_EQ(update_write(0x3F4000, words, 1), KERNEL_RANGE);
  EXPECT_EQ(update_write(0x3E7FFF, words, 2), KERNEL_RANGE);
  EXPECT_EQ(flash.told.size(), 1u);
}

TEST_F(FlashKernel, WritesNoMarkAndNothingBehindOne) {
  std::uint16_t words[] = {HAL_FLASH_ERASED, 1, HAL_FLASH_ERASED};
  EXPECT_EQ(update_write(HAL_FLASH_IMAGE_IDENTITY, words, 3), KERNEL_OK);
  EXPECT_EQ(update_write(HAL_FLASH_IMAGE_IDENTITY - 2, words, 3), KERNEL_OK);
  EXPECT_EQ(update_write(HAL_FLASH_IMAGE_IDENTITY - 1, words, 3), KERNEL_RANGE);
  const std::uint16_t ones[] = {1, 1};
  EXPECT_EQ(update_write(HAL_FLASH_IMAGE_IDENTITY, ones, 1), KERNEL_RANGE) << "also as the first word";
  EXPECT_EQ(update_write(HAL_FLASH_IMAGE_IDENTITY - 1, ones, 1), KERNEL_OK) << "up to it";
  seal();
  EXPECT_EQ(update_write(kBStart, words, 3), KERNEL_STATE);
}

TEST_F(FlashKernel, SealsByTheSumAlone) {
  flash.at(kBStart) = 0x1234;
  const std::uint32_t crc = crc_with_mark();
  EXPECT_EQ(update_seal(crc ^ 1u), KERNEL_STATE);
  EXPECT_TRUE(flash.told.empty());
  EXPECT_EQ(update_seal(crc), KERNEL_OK);
  EXPECT_EQ(update_seal(crc), KERNEL_OK) << "the same again";
  EXPECT_EQ(flash.told, (Told{"program 3E8020 5AA5"}));
  EXPECT_EQ(update_seal(crc ^ 1u), KERNEL_STATE) << "also when the mark is there";
}

TEST_F(FlashKernel, TellsAMarkThatDoesNotStay) {
  flash.programs_nothing = true;
  EXPECT_EQ(update_seal(crc_with_mark()), KERNEL_FLASH);
  EXPECT_EQ(update_failed_at(), HAL_FLASH_IMAGE_IDENTITY);
}

TEST_F(FlashKernel, ChecksFlashAndItsOwnRamOnly) {
  std::uint32_t crc = 0;
  EXPECT_TRUE(update_crc(HAL_FLASH_START, HAL_FLASH_END - HAL_FLASH_START, &crc));
  EXPECT_TRUE(update_crc(HAL_FLASH_END - 1, 1, &crc));
  EXPECT_FALSE(update_crc(HAL_FLASH_END - 1, 2, &crc));
  EXPECT_FALSE(update_crc(HAL_FLASH_END, 1, &crc));
  EXPECT_TRUE(update_crc(HAL_FLASH_KERNEL_RAM, 2, &crc));
  EXPECT_FALSE(update_crc(HAL_FLASH_KERNEL_RAM - 1, 1, &crc));
  EXPECT_FALSE(update_crc(HAL_FLASH_KERNEL_RAM_END - 1, 2, &crc));
  EXPECT_FALSE(update_crc(0xFFFFFFFFu, 0xFFFFFFFFu, &crc));
}

TEST_F(FlashKernel, AnswersWhatItDoesNotKnow) {
  EXPECT_EQ(ask({0x3F, 7}), (std::vector<std::uint16_t>{0xBF, 7, KERNEL_UNKNOWN}));
  EXPECT_EQ(ask({KERNEL_WRITE, 7, 0, 0, 0, 0}), (std::vector<std::uint16_t>{0xB2, 7, KERNEL_LENGTH})) << "no words";
  EXPECT_EQ(ask({KERNEL_WRITE, 7, 0}), (std::vector<std::uint16_t>{0xB2, 7, KERNEL_LENGTH}));
  EXPECT_EQ(ask({KERNEL_WRITE, 7, 0, 0, 0x3F, 0, 1}), (std::vector<std::uint16_t>{0xB2, 7, KERNEL_LENGTH})) << "half";
}

TEST_F(FlashKernel, RequestsOfAnotherLengthAreRefusedUntouched) {
  for (const std::uint16_t type : {KERNEL_INFO, KERNEL_ERASE, KERNEL_CHECK, KERNEL_SEAL, KERNEL_RESTART}) {
    const std::size_t body = type == KERNEL_ERASE ? 1 : type == KERNEL_CHECK ? 8 : type == KERNEL_SEAL ? 4 : 0;
    std::vector<std::uint16_t> request(2 + body);
    request[0] = type;
    EXPECT_NE(status(request), KERNEL_LENGTH) << type;
    request.push_back(0);
    EXPECT_EQ(status(request), KERNEL_LENGTH) << type;
    if (body == 0) continue;
    request.resize(request.size() - 2);
    EXPECT_EQ(status(request), KERNEL_LENGTH) << type;
  }
  EXPECT_TRUE(flash.told.empty());
}

TEST_F(FlashKernel, WritesAsManyWordsAtOnceAsItHasRoomFor) {
  std::vector<std::uint16_t> request{KERNEL_WRITE, 7, 0, 0, 0x3F, 0};
  request.resize(request.size() + 2 * KERNEL_WORDS_MAX, 0x12);
  std::vector<std::uint16_t> more = request;
  more.resize(more.size() + 2, 0x12);
  EXPECT_EQ(status(more), KERNEL_LENGTH);
  EXPECT_TRUE(flash.told.empty());
  EXPECT_EQ(status(request), KERNEL_OK);
  EXPECT_EQ(flash.at(kBStart + KERNEL_WORDS_MAX - 1), 0x1212);
  EXPECT_EQ(flash.at(kBStart + KERNEL_WORDS_MAX), HAL_FLASH_ERASED);
  request.push_back(0x12);
  EXPECT_EQ(status(request), KERNEL_LENGTH) << "half a word is left";
}

// The sum of "12345678" by the standard CRC-32: the host has it from the file.
TEST_F(FlashKernel, TellsTheSumOfWhatIsThere) {
  const std::uint16_t words[] = {0x3231, 0x3433, 0x3635, 0x3837};
  for (std::uint32_t k = 0; k < 4; k++) flash.at(kBStart + k) = words[k];
  EXPECT_EQ(ask({KERNEL_CHECK, 7, 0, 0, 0x3F, 0, 4, 0, 0, 0}),
            (std::vector<std::uint16_t>{0xB3, 7, KERNEL_OK, 0xAF, 0xDA, 0xE0, 0x9A}));
  EXPECT_EQ(ask({KERNEL_CHECK, 7, 0, 0x80, 0x3F, 0, 1, 0, 0, 0}), (std::vector<std::uint16_t>{0xB3, 7, KERNEL_RANGE}))
      << "behind the flash";
}

TEST_F(FlashKernel, TellsWhichChipAndWhichImageItIs) {
  std::vector<std::uint16_t> expected = {KERNEL_INFO | 0x80, 5, KERNEL_OK, KERNEL_PROTOCOL, 0, 0x3C, 0, 3, 0, 0};
  for (std::uint16_t k = 0; k < HAL_IMAGE_WORDS; k++) {
    flash.at(HAL_FLASH_IMAGE_IDENTITY + k) = static_cast<std::uint16_t>(0x4100 + k);
    expected.insert(expected.end(), {k, 0x41});
  }
  for (std::uint16_t k = 0; k < 2; k++) {
    flash.at(HAL_FLASH_BOOT_ENTRY + k) = static_cast<std::uint16_t>(0x5200 + k);
    expected.insert(expected.end(), {k, 0x52});
  }
  EXPECT_EQ(ask({KERNEL_INFO, 5}), expected);
}

TEST_F(FlashKernel, SealsAndRestartsByRequest) {
  const std::uint32_t crc = crc_with_mark();
  const auto octet = [&](int k) { return static_cast<std::uint16_t>(crc >> (8 * k) & 0xFFu); };
  EXPECT_EQ(status({KERNEL_SEAL, 7, octet(0), octet(1), octet(2), octet(3)}), KERNEL_OK);
  EXPECT_EQ(flash.at(HAL_FLASH_IMAGE_IDENTITY), HAL_IMAGE_MARK);
  EXPECT_EQ(ask({KERNEL_RESTART, 8}), (std::vector<std::uint16_t>{0xB5, 8, KERNEL_OK}));
}

TEST_F(FlashKernel, TellsWhetherTheBoardIsLocked) {
  constexpr std::size_t kLocked = 3 + 6;  // behind protocol, part and revision
  EXPECT_EQ(ask({KERNEL_INFO, 1}).at(kLocked), 0);
  flash.locked = true;
  EXPECT_EQ(ask({KERNEL_INFO, 1}).at(kLocked), 1);
}

std::string hex(std::uint32_t value, int digits) {
  char text[16];
  std::snprintf(text, sizeof text, "%0*X", digits, static_cast<unsigned>(value));
  return text;
}

}  // namespace

// ---- the flash as the kernel sees it

extern "C" {

bool hal_flash_is_locked(void) { return flash.locked; }
uint16_t hal_flash_part(void) { return HAL_FLASH_PART; }
uint16_t hal_flash_revision(void) { return 3; }
hal_flash_failure_t hal_flash_failure(void) { return flash.failure; }

uint16_t hal_flash_read(uint32_t address) {
  return address >= HAL_FLASH_START && address < HAL_FLASH_END ? flash.at(address) : 0;
}

hal_flash_result_t hal_flash_erase(uint16_t sector) {
  flash.told.push_back("erase " + std::to_string(sector));
  const std::uint32_t start = HAL_FLASH_END - (sector + 1u) * HAL_FLASH_SECTOR_WORDS;
  for (std::uint32_t a = start; a < start + HAL_FLASH_SECTOR_WORDS; a++) flash.at(a) = HAL_FLASH_ERASED;
  if (flash.stays_low != 0) flash.at(flash.stays_low) = 0xFFFE;
  return flash.erase_gives;
}

hal_flash_result_t hal_flash_program(uint32_t address, const uint16_t* words, uint16_t count) {
  std::string told = "program " + hex(address, 6);
  for (std::uint16_t k = 0; k < count; k++) {
    told += " " + hex(words[k], 4);
    if (!flash.programs_nothing) flash.at(address + k) &= words[k];
  }
  flash.told.push_back(told);
  return flash.program_gives;
}

}  // extern "C"

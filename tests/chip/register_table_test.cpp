// The virtual chip against toolchain/f2808/registers.csv: which registers ask for EALLOW and which take no 16-bit
// access. The chip has its own words for both, not the table's.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

struct Row {
  std::string name;
  std::uint32_t address;
  int width;
  bool eallow, whole;
};

// Every copy of every register that can be written, without the passwords, which are flash.
std::vector<Row> read_table() {
  std::vector<Row> rows;
  std::ifstream file(STILLSPIN_REGISTER_TABLE);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    const bool is_field = !cells[2].empty();
    if (is_field || cells[8] == "read" || cells[8] == "flash") continue;
    const bool eallow = cells[8].find("eallow") != std::string::npos, whole = cells[8].find("32") != std::string::npos;
    const auto step = cells[6].empty() ? 0u : static_cast<std::uint32_t>(std::stoul(cells[6], nullptr, 16));
    auto address = static_cast<std::uint32_t>(std::stoul(cells[3], nullptr, 16));
    for (int copy = std::stoi(cells[5]); copy > 0; --copy, address += step)
      rows.push_back({cells[0] + "." + cells[1], address, std::stoi(cells[7]), eallow, whole});
  }
  return rows;
}

Chip* chip = nullptr;
std::vector<Row> table;
std::vector<std::string> wrong;
int compared = 0, protected_ones = 0, whole_ones = 0;

void clocks_on() {
  write_protected(REG_PCLKCR0, 0xFFFF);
  write_protected(REG_PCLKCR1, 0xFFFF);
}

void compare(const Row& row) {
  const auto before = chip->statistics();
  if (row.width == 32) {
    target_write32(row.address, 0);
  } else {
    target_write16(row.address, 0);
  }
  const auto after = chip->statistics();
  if (after.unmodelled_accesses != before.unmodelled_accesses || after.gated_accesses != before.gated_accesses) return;
  compared++;
  protected_ones += row.eallow ? 1 : 0;
  whole_ones += row.whole ? 1 : 0;
  if ((after.protected_writes_lost != before.protected_writes_lost) != row.eallow)
    wrong.push_back(row.name + " EALLOW");
  if (row.width != 32) return;
  (void)target_read16(row.address);
  if ((chip->statistics().narrow_can_accesses != after.narrow_can_accesses) != row.whole)
    wrong.push_back(row.name + " width");
}

TEST(RegisterTable, ChipProtectsAndSplitsAsTheTableSays) {
  table = read_table();
  ASSERT_GT(table.size(), 600u);
  RecordingWorld world;
  Chip device(world, [] {
    disable_watchdog();
    clocks_on();
    for (const Row& row : table) compare(row);
    sleep_for_ever();
  });
  chip = &device;
  device.run_until(1'000'000);
  EXPECT_EQ(device.error(), "");
  EXPECT_EQ(wrong, std::vector<std::string>{});
  // Few enough are not modelled: eCAP, SPI, CSM, the second of each serial port and encoder.
  EXPECT_GT(compared, 540);
  EXPECT_GT(protected_ones, 70);
  EXPECT_EQ(whole_ones, 26);
  EXPECT_GT(device.statistics().protected_writes_lost, 70u);
}

}  // namespace

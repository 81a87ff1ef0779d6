// The C28x core and what it is connected to: mapped memory, a bus of peripherals, vectors, and what the words are that
// are no instruction. What the instructions do is tested from Python (test_c28x_*.py).

#include "sim_host/chip/c28x/core.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace stillspin::c28x;

constexpr std::uint16_t kEstop0 = 0x7625;
constexpr std::uint32_t kPeripheral = 0x6000;

struct Access {
  std::string kind;
  std::uint32_t address;
  std::uint32_t value;
  bool eallow;

  bool operator==(const Access& other) const {
    return kind == other.kind && address == other.address && value == other.value && eallow == other.eallow;
  }
};

class Recorder final : public Bus {
 public:
  std::uint16_t read(std::uint32_t address) override { return note("read", address, 0x1234); }
  void write(std::uint32_t address, std::uint16_t value) override { note("write", address, value); }
  std::uint32_t read_pair(std::uint32_t address) override {
    note("read pair", address, 0);
    return 0x89ABCDEF;
  }
  void write_pair(std::uint32_t address, std::uint32_t value) override { note("write pair", address, value); }
  std::uint32_t vector(unsigned number, std::uint32_t listed) override {
    note("vector", number, listed);
    return 0x2000;
  }
  std::uint16_t read_port(std::uint16_t port) override { return note("in", port, 0x4321); }
  void write_port(std::uint16_t port, std::uint16_t value) override { note("out", port, value); }

  const Core* core = nullptr;
  std::vector<Access> seen;

 private:
  std::uint16_t note(const char* kind, std::uint32_t address, std::uint32_t value) {
    seen.push_back({kind, address, value, core->r.eallow});
    return static_cast<std::uint16_t>(value);
  }
};

class CoreTest : public testing::Test {
 protected:
  CoreTest() : ram_(0x6000), core_(bus_) {
    bus_.core = &core_;
    core_.map(0, 0x6000, ram_.data(), true);
    core_.r.pc = 0x1000;
    core_.set_stop_at_breakpoint(true);
  }

  Stop run(const std::vector<std::uint16_t>& words) {
    std::uint32_t at = 0x1000;
    for (const std::uint16_t word : words) ram_[at++] = word;
    ram_[at] = kEstop0;
    return core_.run(core_.cycles + 1000);
  }

  std::vector<std::uint16_t> ram_;
  Recorder bus_;
  Core core_;
};

TEST_F(CoreTest, AsksTheBusForWhatIsNotMapped) {
  core_.r.xar[4] = kPeripheral;
  ASSERT_EQ(run({0x9284, 0x7622, 0x9684, 0x761A}), Stop::kBreakpoint);  // MOV AL,*XAR4++; EALLOW; MOV *XAR4++,AL; EDIS
  const std::vector<Access> expected = {{"read", kPeripheral, 0x1234, false}, {"write", kPeripheral + 1, 0x1234, true}};
  EXPECT_EQ(bus_.seen, expected);
  EXPECT_FALSE(core_.r.eallow);
}

TEST_F(CoreTest, TakesLongsAsOneAccessAtAnEvenAddress) {
  core_.r.xar[4] = kPeripheral + 3;
  ASSERT_EQ(run({0x06C4, 0x1EC4}), Stop::kBreakpoint);  // MOVL ACC,*+XAR4[0]; MOVL *+XAR4[0],ACC
  const std::vector<Access> expected = {{"read pair", kPeripheral + 2, 0, false},
                                        {"write pair", kPeripheral + 2, 0x89ABCDEF, false}};
  EXPECT_EQ(bus_.seen, expected);
}

TEST_F(CoreTest, LeavesWritesToReadOnlyMemoryToTheBus) {
  std::vector<std::uint16_t> flash(Core::kPage, 0x5555);
  core_.map(0x3F4000, Core::kPage, flash.data(), false);
  core_.r.xar[4] = 0x3F4000;
  ASSERT_EQ(run({0x9284, 0x9684}), Stop::kBreakpoint);
  const std::vector<Access> expected = {{"write", 0x3F4001, 0x5555, false}};
  EXPECT_EQ(bus_.seen, expected);
  EXPECT_EQ(flash[1], 0x5555);
}

TEST_F(CoreTest, HasAnInputAndOutputSpace) {
  ASSERT_EQ(run({0xB4A9, 0x0040, 0xBCA9, 0x0041}), Stop::kBreakpoint);  // IN AL,*(0x40); OUT *(0x41),AL
  const std::vector<Access> expected = {{"in", 0x40, 0x4321, false}, {"out", 0x41, 0x4321, false}};
  EXPECT_EQ(bus_.seen, expected);
}

TEST_F(CoreTest, AsksTheBusWhereAVectorPoints) {
  ram_[0x2000] = kEstop0;
  core_.r.vmap = false;
  ram_[2 * 3] = 0x1111;
  ram_[2 * 3 + 1] = 0x0022;
  core_.r.ier = 1U << 2;
  core_.r.intm = false;
  core_.request(3);
  ASSERT_EQ(run({0x7700}), Stop::kBreakpoint);
  const std::vector<Access> expected = {{"vector", 3, 0x221111, false}};
  EXPECT_EQ(bus_.seen, expected);
  EXPECT_EQ(core_.r.pc, 0x2000U);
}

TEST_F(CoreTest, StartsAtTheResetVector) {
  core_.r.acc = 7;
  core_.r.objmode = true;
  core_.reset();
  EXPECT_EQ(core_.r.pc, 0x2000U);
  EXPECT_EQ(bus_.seen.back().kind, "vector");
  EXPECT_EQ(core_.r.acc, 0U);
  EXPECT_EQ(core_.r.sp, 0x400);
  EXPECT_EQ(core_.r.st0(), 0);
  EXPECT_EQ(core_.r.st1(), 0x080B);
}

TEST_F(CoreTest, SeesCodeThatWasWrittenOver) {
  ASSERT_EQ(run({0x9A05}), Stop::kBreakpoint);  // MOVB AL,#5
  core_.r.pc = 0x1000;
  ASSERT_EQ(run({0x9A06}), Stop::kBreakpoint);
  EXPECT_EQ(core_.r.acc, 6U);
}

TEST_F(CoreTest, StopsWhenTheCyclesAreUsedUpAndGoesOn) {
  ram_[0x1000] = 0x6F00;  // SB 0x1000,UNC
  EXPECT_EQ(core_.run(70), Stop::kNone);
  EXPECT_EQ(core_.cycles, 70U);
  EXPECT_EQ(core_.instructions, 10U);
  EXPECT_EQ(core_.run(70), Stop::kNone);
  EXPECT_EQ(core_.instructions, 10U);
}

TEST_F(CoreTest, PassesBreakpointsWhereNobodyStopsAtThem) {
  core_.set_stop_at_breakpoint(false);
  ram_[0x1001] = 0x7621;  // IDLE
  ram_[0x1000] = kEstop0;
  EXPECT_EQ(core_.run(1000), Stop::kIdle);
  EXPECT_EQ(core_.r.pc, 0x1002U);
}

TEST_F(CoreTest, TakesTheRegistersOfTheWrongWidthForNoInstruction) {
  for (const unsigned loc : {0xA8U, 0xAAU, 0xADU}) {
    EXPECT_EQ(decode(0, static_cast<std::uint16_t>(0x0600 | loc), 0).form, kNoForm);  // MOVL ACC,loc32
    EXPECT_NE(decode(0, static_cast<std::uint16_t>(0x9200 | loc), 0).form, kNoForm);  // MOV AL,loc16
    EXPECT_EQ(decode(0, static_cast<std::uint16_t>(0xA500 | loc), 0).form, kNoForm);  // DMOV mem16
  }
  EXPECT_NE(decode(0, 0x06A9, 0).form, kNoForm);
}

}  // namespace

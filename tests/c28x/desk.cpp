// The core on a desk: commands on the standard input, answers on the standard output, for tests in other languages.
//
//     fresh                    memory and registers as at the beginning; RAM at 0x000000 and 0x3F0000, 64 Ki words each
//     set NAME VALUE           a register or a flag; numbers are hexadecimal
//     put ADDRESS WORD...      words into memory
//     step COUNT               instructions
//     go CYCLES                until ESTOP0 or IDLE, or as long as that; answers how it ended
//     request NUMBER | nmi     an interrupt
//     state                    answers all registers, NAME=VALUE each
//     get ADDRESS COUNT        answers words of memory
//     decode WORD WORD         answers the number of the form, ffff for none, and its words
//     executed                 answers the numbers of the forms that were executed since the program began
//     cycles                   answers cycles and instructions since `fresh`
//     region FIRST WORDS ...   what the accesses of memory cost: the members of Region in their order
//     waits                    answers the cycles waited for registers, data and fetches since `fresh`

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "sim_host/chip/c28x/core.hpp"

namespace {

using namespace stillspin::c28x;

constexpr std::uint32_t kBlock = 0x10000;
constexpr std::uint32_t kHigh = 0x3F0000;

class NoMemory final : public Bus {
 public:
  std::uint16_t read(std::uint32_t) override { return 0; }
  void write(std::uint32_t, std::uint16_t) override {}
};

class Desk {
 public:
  Desk() { fresh(); }

  void obey(const std::string& line) {
    std::istringstream words(line);
    words >> std::hex;
    std::string command;
    words >> command;
    if (command == "fresh") fresh();
    if (command == "set") set(words);
    if (command == "put") put(words);
    if (command == "step") step(words);
    if (command == "go") go(words);
    if (command == "request") core_->request(number(words));
    if (command == "nmi") core_->request_nmi();
    if (command == "state") state();
    if (command == "get") get(words);
    if (command == "decode") decode_pair(words);
    if (command == "executed") executed();
    if (command == "region") region(words);
    if (command == "waits") {
      const Waits& waits = core_->waits;
      std::cout << waits.registers << ' ' << waits.data << ' ' << waits.fetch << '\n';
    }
    if (command == "cycles") std::cout << core_->cycles << ' ' << core_->instructions << '\n';
  }

 private:
  static std::uint32_t number(std::istream& words) {
    std::uint32_t value = 0;
    words >> value;
    return value;
  }

  void fresh() {
    if (core_) count();
    low_.assign(kBlock, 0);
    high_.assign(kBlock, 0);
    core_ = std::make_unique<Core>(bus_);
    core_->map(0, kBlock, low_.data(), true);
    core_->map(kHigh, kBlock, high_.data(), true);
    core_->jump(0);
    core_->r.objmode = true;
    core_->set_stop_at_breakpoint(true);
    name_registers();
    regions_.clear();
  }

  template <typename Value>
  void name(const std::string& text, Value& value) {
    read_[text] = [&value] { return static_cast<std::uint32_t>(value) & mask<Value>(); };
    write_[text] = [&value](std::uint32_t from) { value = static_cast<Value>(from); };
  }
  template <typename Value>
  static constexpr std::uint32_t mask() {
    return sizeof(Value) == 4 ? 0xFFFFFFFFU : (1U << (8 * sizeof(Value) % 32)) - 1;
  }

  void name_registers() {
    Registers& r = core_->r;
    for (unsigned n = 0; n < 8; ++n) name("xar" + std::to_string(n), r.xar[n]);
    name("acc", r.acc), name("p", r.p), name("xt", r.xt), name("pc", r.pc), name("rpc", r.rpc);
    name("sp", r.sp), name("dp", r.dp), name("ifr", r.ifr), name("ier", r.ier), name("dbgier", r.dbgier);
    name("sxm", r.sxm), name("ovm", r.ovm), name("tc", r.tc), name("c", r.c), name("z", r.z), name("n", r.n);
    name("v", r.v), name("pm", r.pm), name("ovc", r.ovc), name("intm", r.intm), name("dbgm", r.dbgm);
    name("page0", r.page0), name("vmap", r.vmap), name("spa", r.spa), name("loop", r.loop);
    name("eallow", r.eallow), name("idlestat", r.idlestat), name("amode", r.amode), name("objmode", r.objmode);
    name("m0m1map", r.m0m1map), name("xf", r.xf), name("arp", r.arp);
  }

  void set(std::istream& words) {
    std::string register_name;
    words >> register_name;
    write_.at(register_name)(number(words));
    if (register_name == "pc") core_->jump(core_->r.pc);
  }
  void region(std::istream& words) {
    const std::uint32_t first = number(words);
    const std::uint32_t count = number(words);
    Region& made = regions_.emplace_back();
    for (std::uint8_t* member :
         {&made.block, &made.read_waits, &made.fetch_shift, &made.fetch_first, &made.fetch_next, &made.ahead}) {
      *member = static_cast<std::uint8_t>(number(words));
    }
    made.ordered = number(words) != 0;
    core_->set_region(first, count, made);
  }
  void put(std::istream& words) {
    std::uint32_t address = number(words);
    for (std::uint32_t word = 0; words >> word;)
      core_->MappedMemory::write16(address++, static_cast<std::uint16_t>(word));
  }
  void step(std::istream& words) {
    for (std::uint32_t count = number(words); count > 0; --count) core_->step();
  }
  void go(std::istream& words) {
    static const char* const ends[] = {"cycles", "idle", "breakpoint", "unmodelled"};
    std::cout << ends[static_cast<unsigned>(core_->run(core_->cycles + number(words)))] << '\n';
  }
  void state() {
    for (const auto& [register_name, value] : read_) std::cout << register_name << '=' << std::hex << value() << ' ';
    std::cout << std::dec << '\n';
  }
  void get(std::istream& words) {
    const std::uint32_t address = number(words);
    const std::uint32_t count = number(words);
    for (std::uint32_t k = 0; k < count; ++k) std::cout << std::hex << core_->MappedMemory::read16(address + k) << ' ';
    std::cout << std::dec << '\n';
  }
  static void decode_pair(std::istream& words) {
    const std::uint32_t first = number(words);
    const std::uint32_t second = number(words);
    const Instruction i = decode(0, static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(second));
    std::cout << std::hex << i.form << ' ' << unsigned{i.words} << std::dec << '\n';
  }
  void count() {
    seen_.resize(kFormCount);
    for (std::size_t k = 0; k < kFormCount; ++k) seen_[k] += core_->executed[k];
  }
  void executed() {
    count();
    for (std::size_t k = 0; k < kFormCount; ++k) {
      if (seen_[k] != 0) std::cout << std::hex << k << ' ';
    }
    std::cout << std::dec << '\n';
  }

  NoMemory bus_;
  std::vector<std::uint16_t> low_;
  std::vector<std::uint16_t> high_;
  std::deque<Region> regions_;
  std::unique_ptr<Core> core_;
  std::vector<std::uint64_t> seen_;
  std::map<std::string, std::function<std::uint32_t()>> read_;
  std::map<std::string, std::function<void(std::uint32_t)>> write_;
};

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  Desk desk;
  for (std::string line; std::getline(std::cin, line);) desk.obey(line);
  return 0;
}

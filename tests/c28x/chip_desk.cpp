// A virtual chip that executes code, on a desk: commands on the standard input, answers on the standard output. Numbers
// are hexadecimal, ticks too.
//
//     put ADDRESS WORD...      words into flash and RAM, before or between runs
//     library ERASE PROGRAM VERIFY SCALE   where the program has TI's flash library, 0 for what it has not
//     run TICK                 until then, through the boot ROM, with its pins at flash boot unless they are set
//     level PIN 0|1            of a pin that is read
//     code CHANNEL WORD        what the converter sees
//     rate BITS                a second at the far end of the serial port, 115200 at first
//     send OCTET...            at the serial port
//     get ADDRESS COUNT        answers registers and memory as they are
//     cycles                   answers cycles, instructions and the cycles waited for registers, data and fetches
//     heard                    answers what the port has sent: ticks and octets
//     edges                    answers the edges of ePWM pins: TICK MODULE A B; those of each time once
//     pins                     answers those of outputs: TICK PIN LEVEL
//     counts                   answers interrupts, lost writes, unmodelled accesses, resets

#include <array>
#include <cstdint>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_host/chip/boot_rom.hpp"
#include "sim_host/chip/c28x/core.hpp"
#include "sim_host/chip/chip.hpp"
#include "sim_host/devices/serial_line.hpp"

namespace {

using namespace stillspin::chip;

class Desk final : public World {
 public:
  void obey(const std::string& line) {
    std::istringstream words(line);
    words >> std::hex;
    std::string command;
    words >> command;
    if (command == "put") put(words);
    if (command == "library") replace_library(words);
    if (command == "run") chip_.run_until(static_cast<Tick>(number(words)));
    if (command == "level") set_level(words);
    if (command == "code") set_code(words);
    if (command == "rate") line_.set_rate(number(words));
    if (command == "send") send(words);
    if (command == "get") get(words);
    if (command == "cycles") cycles();
    if (command == "heard") answer(heard_);
    if (command == "edges") answer(edges_);
    if (command == "pins") answer(pins_);
    if (command == "counts") counts();
  }

  void on_pwm_pins(Tick t, int module, bool a, bool b) override {
    edges_ << t << ' ' << module << ' ' << a << ' ' << b << ' ';
  }
  std::uint16_t adc_sample(Tick, int channel) override { return codes_[static_cast<std::size_t>(channel)]; }
  bool pin_level(Tick t, int pin) override {
    return pin == 28 ? line_.level(t) : levels_[static_cast<std::size_t>(pin)];
  }
  void on_output_pin(Tick t, int pin, bool level) override { pins_ << t << ' ' << pin << ' ' << level << ' '; }
  std::int64_t encoder_edges(Tick) override { return 0; }
  Tick serial_reaches(Tick t, bool level) override { return line_.reaches(t, level); }
  void on_serial_frame(Tick t, const SerialFrame& frame) override {
    heard_ << t << ' ' << (frame.levels >> 1 & 0xFFU) << ' ';
  }
  Tick next_call() const override { return kNever; }
  void call(Tick) override {}

 private:
  static std::uint32_t number(std::istream& words) {
    std::uint32_t value = 0;
    words >> value;
    return value;
  }
  static void answer(std::ostringstream& record) {
    std::cout << record.str() << '\n';
    record.str("");
  }

  void put(std::istream& words) {
    const std::uint32_t address = number(words);
    CodeBlocks blocks{{address, {}}};
    for (std::uint32_t word = 0; words >> word;) blocks[0].second.push_back(static_cast<std::uint16_t>(word));
    chip_.load(blocks);
  }
  void replace_library(std::istream& words) {
    FlashLibrary places;
    for (std::uint32_t* place : {&places.erase, &places.program, &places.verify, &places.scale}) *place = number(words);
    chip_.replace_flash_library(places);
  }
  void set_level(std::istream& words) {
    const std::uint32_t pin = number(words);
    levels_.at(pin) = number(words) != 0;
    chip_.pins_changed();
  }
  void set_code(std::istream& words) {
    const std::uint32_t channel = number(words);
    codes_.at(channel) = static_cast<std::uint16_t>(number(words));
  }
  void send(std::istream& words) {
    std::vector<std::uint8_t> octets;
    for (std::uint32_t octet = 0; words >> octet;) octets.push_back(static_cast<std::uint8_t>(octet));
    line_.send(octets, chip_.now());
  }
  void get(std::istream& words) {
    const std::uint32_t address = number(words);
    const std::uint32_t count = number(words);
    for (std::uint32_t k = 0; k < count; ++k) std::cout << std::hex << chip_.inspect(address + k) << ' ';
    std::cout << std::dec << '\n';
  }
  void cycles() {
    const stillspin::c28x::Core& core = core_;
    std::cout << core.cycles << ' ' << core.instructions << ' ' << core.waits.registers << ' ' << core.waits.data << ' '
              << core.waits.fetch << '\n';
  }
  void counts() {
    const Statistics s = chip_.statistics();
    std::cout << s.interrupts << ' ' << s.protected_writes_lost + s.gated_accesses << ' ' << s.unmodelled_accesses
              << ' ' << s.resets << '\n';
  }

  std::array<bool, 35> levels_ = [] {
    std::array<bool, 35> levels{};
    levels.fill(true);
    return levels;
  }();
  std::array<std::uint16_t, 16> codes_{};
  stillspin::devices::SerialLine line_;
  std::ostringstream heard_, edges_, pins_;
  Chip chip_{*this, boot_rom};
  stillspin::c28x::Core& core_ = chip_.execute_code();
};

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  Desk desk;
  try {
    for (std::string line; std::getline(std::cin, line);) desk.obey(line);
  } catch (const std::exception& error) {
    std::cout << "error: " << error.what() << '\n';
  }
  return 0;
}

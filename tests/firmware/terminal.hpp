// The other end of the serial port: sends text and records to the firmware and collects what comes back.

#ifndef STILLSPIN_TESTS_FIRMWARE_TERMINAL_HPP
#define STILLSPIN_TESTS_FIRMWARE_TERMINAL_HPP

#include <string>
#include <vector>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/fake_hal.hpp"
#include "tests/firmware/fake_nvm.hpp"

extern "C" {
#include "firmware/console/console.h"
#include "firmware/link/link.h"
#include "firmware/link/requests.h"
#include "firmware/link/stream.h"
#include "firmware/store/store.h"
}

namespace stillspin::test {

using Octets = std::vector<std::uint16_t>;

/// Octets of a number, little-endian.
inline Octets little(std::uint32_t value, int octets) {
  Octets o;
  for (int k = 0; k < octets; ++k) o.push_back(static_cast<std::uint16_t>((value >> (8 * k)) & 0xFFu));
  return o;
}

inline Octets operator+(Octets a, const Octets& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A record as it came back: without the CRC.
struct Answer {
  Octets octets;
  bool came() const { return !octets.empty(); }
  unsigned type() const { return octets.at(0); }
  unsigned tag() const { return octets.at(1); }
  unsigned status() const { return octets.at(2); }
  std::uint32_t number(std::size_t at, int size) const {
    std::uint32_t value = 0;
    for (int k = 0; k < size; ++k) value |= static_cast<std::uint32_t>(octets.at(3 + at + std::size_t(k))) << (8 * k);
    return value;
  }
  std::string text(std::size_t at = 0) const {
    return std::string(octets.begin() + static_cast<std::ptrdiff_t>(3 + at), octets.end());
  }
  std::size_t body() const { return octets.size() - 3; }
};

class Terminal : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    link_reset();
    console_reset();
    nvm = FakeNvm{};
    splitter_reset(&far_);
    run(400);  // the tables' check sum
  }

  /// Rounds of the background level, ten to a millisecond; the port sends 11 octets in each of those.
  void run(int rounds) {
    for (int k = 0; k < rounds; ++k) {
      if (++rounds_ % 10 == 0) {
        inside::time_ms()++;
        board.serial_room = static_cast<std::uint16_t>(std::min<int>(HAL_SCI_TRANSMIT_RING, board.serial_room + 12));
      }
      inside::heartbeat()++;
      store_service();
      link_service();
      console_service();
      collect();
    }
  }

  void send(const Octets& octets) { board.serial_in.insert(board.serial_in.end(), octets.begin(), octets.end()); }
  void send(const std::string& line) { send(Octets(line.begin(), line.end())); }
  void send_record(Octets record) {
    const auto n = static_cast<std::uint16_t>(record.size());
    record.resize(RECORD_MAX);
    Octets out(RECORD_ENCODED_MAX + 2);
    out.resize(record_to_wire(record.data(), n, out.data()));
    send(out);
  }

  /// What comes back to a line, echo and prompt taken off.
  std::string command(const std::string& line, int rounds = 4000) {
    text.clear();
    send(line + "\r");
    run(rounds);
    std::string back = text;
    const std::string echo = line + "\r\n";
    if (back.compare(0, echo.size(), echo) == 0) back.erase(0, echo.size());
    const std::string prompt = "> ";
    if (back.size() >= 2 && back.compare(back.size() - 2, 2, prompt) == 0) back.erase(back.size() - 2);
    return back;
  }

  Answer ask(unsigned type, const Octets& body = {}) {
    records.clear();
    tag_ = (tag_ + 1) & 0xFF;
    send_record(Octets{static_cast<std::uint16_t>(type), static_cast<std::uint16_t>(tag_)} + body);
    run(400);
    for (const Octets& r : records) {
      if (r[0] == (type | RECORD_ANSWER) && r[1] == tag_) return {r};
    }
    return {};
  }

  std::string text;             // that came back
  std::vector<Octets> records;  // that came back, without their CRC

 private:
  void collect() {
    while (!board.serial_out.empty()) {
      const std::int16_t found = splitter_octet(&far_, board.serial_out.front(), inside::time_ms());
      board.serial_out.pop_front();
      if (found == SPLITTER_RECORD) records.emplace_back(far_.octets, far_.octets + far_.count);
      for (int k = 0; k < found; ++k) text += static_cast<char>(far_.octets[k]);
    }
    ASSERT_EQ(far_.errors.damaged, 0) << "what was sent is no record";
  }

  splitter_t far_;
  unsigned tag_ = 0;
  int rounds_ = 0;
};

}  // namespace stillspin::test

#endif

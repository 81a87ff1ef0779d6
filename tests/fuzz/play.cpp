#include "tests/fuzz/play.hpp"

#include <algorithm>
#include <vector>

#include "tests/firmware/fake_hal.hpp"
#include "tests/fuzz/fuzz_board.hpp"
#include "tests/fuzz/fuzz_drive.h"

extern "C" {
#include "firmware/link/record.h"
#include "firmware/link/requests.h"
#include "firmware/link/splitter.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {
namespace {

constexpr std::uint8_t kHappens = 0xFC, kRecord = 0xFD, kTime = 0xFE;
constexpr int kRounds = 4;              // of the background level in a step of time
constexpr int kOctetsPerMs = 12;        // that the port sends: 115200 Bd
constexpr int kFine = 4, kCoarse = 25;  // steps of 1 ms, then of 25 ms

class Player {
 public:
  Player() {
    fuzz_power_on();
    splitter_reset(&far_);
  }

  void play(const std::uint8_t* at, const std::uint8_t* end) {
    while (at < end && problem.empty()) {
      const std::uint8_t octet = *at++;
      if (octet < kHappens || at == end) {
        send(octet);
      } else if (octet == kRecord) {
        const auto n = static_cast<std::ptrdiff_t>(*at++ % 64);
        const std::uint8_t* const stop = at + std::min(n, end - at);
        send_record({at, stop});
        at = stop;
      } else if (octet == kTime) {
        pass(*at++);
      } else if (octet == kHappens) {
        happen(*at++);
      }
    }
    for (int k = 0; k < 2000 && !board.serial_in.empty(); ++k) step(1);
  }

  /// Whatever was sent: after the rest that ends a record, a line stops the drive and a record is answered.
  void judge() {
    pass(150);
    if (!fuzz_has_host()) judge_stop();
    if (fuzz_has_host() && board.gates_on) fail("the gates are on with the host in the loop");
    records.clear();
    send_record({REQUEST_STATUS, 0x5A});
    for (int k = 0; k < 1000 && !answered(); ++k) step(1);
    if (!answered()) fail("a request for the status was not answered");
    const std::string wrong = fuzz_complaint_of_parameters();
    if (!wrong.empty()) fail(wrong);
  }

  std::string problem;

 private:
  void fail(const std::string& what) {
    if (problem.empty()) problem = what;
  }

  // The interrupt is held off until the line has been understood, so that nothing else can have stopped the drive.
  void judge_stop() {
    fuzz_put_into(DRIVE_RUN);
    fuzz_background();
    fuzz_forget_requests();
    for (const char c : std::string("\r\nstop\r\n")) send(static_cast<std::uint8_t>(c), false);
    for (int k = 0; k < 1000 && !fuzz_is_to_stop(); ++k) rounds(1);
    if (!fuzz_is_running()) fail("the drive did not run any more");
    fuzz_background();  // changed parameters come first
    fuzz_pass(1);
    if (fuzz_is_running()) fail("the drive was not stopped");
  }

  bool answered() const {
    return std::any_of(records.begin(), records.end(), [](const auto& r) {
      return r.size() == 28 && r[0] == (REQUEST_STATUS | RECORD_ANSWER) && r[1] == 0x5A && r[2] == 0;
    });
  }

  void send(std::uint16_t octet, bool time_passes = true) {
    // A real port loses what finds its ring full, and counts it; that is not what is looked for here.
    while (board.serial_in.size() >= HAL_SCI_RECEIVE_RING) time_passes ? step(1) : rounds(1);
    board.serial_in.push_back(octet);
  }

  void send_record(std::vector<std::uint16_t> record) {
    std::uint16_t wire[RECORD_ENCODED_MAX + 2];
    const auto n = static_cast<std::uint16_t>(record.size());
    record.resize(RECORD_MAX);
    const std::uint16_t octets = record_to_wire(record.data(), n, wire);
    for (int k = 0; k < octets; ++k) send(wire[k]);
  }

  void happen(std::uint8_t what) {
    switch (what % 4) {
      case 0:
        fuzz_fault(what / 4);
        break;
      case 1:
        fuzz_put_into(what / 4 % FUZZ_STATES);
        break;
      case 2:
        board.serial_errors.framing++;
        break;
      default:
        board.encoder = what * 0x01234567u;
        break;
    }
  }

  void pass(int ms) {
    for (int k = 0; ms > 0; ++k) {
      const int now = k < kFine ? 1 : std::min(ms, kCoarse);
      step(now);
      ms -= now;
    }
  }

  void step(int ms) {
    fuzz_pass(static_cast<std::uint16_t>(ms));
    rounds(ms);
  }

  // The background level while `ms` of octets go out.
  void rounds(int ms) {
    for (int k = 0; k < kRounds; ++k) {
      const int room = board.serial_room + ms * kOctetsPerMs / kRounds;
      board.serial_room = static_cast<std::uint16_t>(std::min<int>(HAL_SCI_TRANSMIT_RING, room));
      fuzz_serve_port();
      listen();
    }
  }

  void listen() {
    while (!board.serial_out.empty()) {
      const std::uint16_t octet = board.serial_out.front();
      board.serial_out.pop_front();
      const std::int16_t found = splitter_octet(&far_, octet, fuzz_time_ms());
      if (found == SPLITTER_RECORD) records.emplace_back(far_.octets, far_.octets + far_.count);
      for (int k = 0; k < found; ++k) {
        if (far_.octets[k] > 0x7E) fail("text that is not ASCII");
      }
      if (far_.errors.damaged + far_.errors.too_long != 0) fail("what the drive sends is no record");
    }
  }

  std::vector<std::vector<std::uint16_t>> records;
  splitter_t far_;
};

}  // namespace

std::string play(const std::uint8_t* octets, std::size_t count) {
  Player player;
  player.play(octets, octets + count);
  if (player.problem.empty()) player.judge();
  return player.problem;
}

}  // namespace stillspin::test

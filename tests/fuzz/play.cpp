#include "tests/fuzz/play.hpp"

#include <algorithm>
#include <vector>

#include "tests/firmware/fake_hal.hpp"
#include "tests/firmware/fake_nvm.hpp"

extern "C" {
#include "firmware/console/console.h"
#include "firmware/hil/hil.h"
#include "firmware/link/link.h"
#include "firmware/link/requests.h"
#include "firmware/store/store.h"
}

namespace stillspin::test {
namespace {

constexpr std::uint8_t kHappens = 0xFC, kRecord = 0xFD, kTime = 0xFE;
constexpr int kRoundsPerMs = 4;
constexpr int kDrain = 3;  // octets that the port sends in a round: 115200 Bd

class Player {
 public:
  Player() {
    board = FakeBoard{};
    if (nvm.octets > 0) nvm = FakeNvm{};
    drive_reset();
    hil_reset();
    link_reset();
    splitter_reset(&far_);
    drive.state = DRIVE_READY;
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
        rounds(*at++ * kRoundsPerMs);
      } else if (octet == kHappens) {
        happen(*at++);
      }
    }
    for (int k = 0; k < 2000 && !board.serial_in.empty(); ++k) rounds(kRoundsPerMs);
  }

  /// Whatever was sent: after the rest that ends a record, a line stops the drive and a record is answered.
  void judge() {
    rounds(150 * kRoundsPerMs);
    drive.state = DRIVE_RUN;
    drive.request = {};
    for (const char c : std::string("\r\nstop\r\n")) send(static_cast<std::uint8_t>(c));
    obeying_ = false;
    for (int k = 0; k < 4000 && !drive.request.stop; ++k) rounds(1);
    if (!drive.request.stop) fail("the drive was not stopped");
    records.clear();
    send_record({REQUEST_STATUS, 0x5A});
    for (int k = 0; k < 4000 && !answered(); ++k) rounds(1);
    if (!answered()) fail("a request for the status was not answered");
    for (std::uint16_t k = 0; k < parameter_count(); ++k) {
      const parameter_info_t& p = *parameter_info(k);
      const std::int32_t raw = parameter_get(p.id);
      if (raw < p.minimum || raw > p.maximum) fail(std::string(p.name) + " is out of its range");
    }
  }

  std::string problem;

 private:
  void fail(const std::string& what) {
    if (problem.empty()) problem = what;
  }

  bool answered() const {
    return std::any_of(records.begin(), records.end(), [](const auto& r) {
      return r.size() == 26 && r[0] == (REQUEST_STATUS | RECORD_ANSWER) && r[1] == 0x5A && r[2] == 0;
    });
  }

  void send(std::uint16_t octet) {
    // A real port loses what finds its ring full, and counts it; that is not what is looked for here.
    while (board.serial_in.size() >= HAL_SCI_RECEIVE_RING) rounds(1);
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
        drive_raise(&drive, static_cast<drive_fault_t>(1 + what / 4 % 13));
        break;
      case 1:
        drive.state = static_cast<drive_state_t>(what / 4 % 8);
        break;
      case 2:
        board.serial_errors.framing++;
        break;
      default:
        drive.signals.speed = static_cast<std::int32_t>(what * 0x01234567u);
        drive.signals.limit = what;
        break;
    }
  }

  // What the control interrupt would make of the requests.
  void obey() {
    drive_request_t& r = drive.request;
    const bool energised = drive_is_energised();
    if (energised && (r.stop || r.coast)) drive.state = DRIVE_READY;
    if (!energised && drive.state == DRIVE_READY && r.start) drive.state = DRIVE_RUN;
    if (drive.state == DRIVE_FAULT && r.reset) drive.state = DRIVE_READY;
    r = {};
  }

  void rounds(int count) {
    for (int k = 0; k < count; ++k) {
      if (++round_ % kRoundsPerMs == 0) {
        drive.time_ms++;
        drive.heartbeat++;
        if (obeying_) obey();
      }
      board.serial_room = static_cast<std::uint16_t>(std::min<int>(HAL_SCI_TRANSMIT_RING, board.serial_room + kDrain));
      store_service();
      link_service();
      console_service();
      listen();
    }
  }

  void listen() {
    while (!board.serial_out.empty()) {
      const std::uint16_t octet = board.serial_out.front();
      board.serial_out.pop_front();
      const std::int16_t found = splitter_octet(&far_, octet, drive.time_ms);
      if (found == SPLITTER_RECORD) records.emplace_back(far_.octets, far_.octets + far_.count);
      for (int k = 0; k < found; ++k) {
        if (far_.octets[k] > 0x7E) fail("text that is not ASCII");
      }
      if (far_.errors.damaged + far_.errors.too_long != 0) fail("what the drive sends is no record");
    }
  }

  std::vector<std::vector<std::uint16_t>> records;
  splitter_t far_;
  int round_ = 0;
  bool obeying_ = true;
};

}  // namespace

std::string play(const std::uint8_t* octets, std::size_t count) {
  Player player;
  player.play(octets, octets + count);
  if (player.problem.empty()) player.judge();
  return player.problem;
}

}  // namespace stillspin::test

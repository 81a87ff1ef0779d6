#include "tests/fuzz/play_bus.hpp"

#include <algorithm>
#include <vector>

#include "tests/firmware/fake_hal.hpp"
#include "tests/firmware/fake_nvm.hpp"

extern "C" {
#include "firmware/can/command.h"
#include "firmware/can/messages.h"
#include "firmware/can/node.h"
#include "firmware/can/segments.h"
#include "firmware/hil/hil.h"
#include "firmware/link/requests.h"
}

namespace stillspin::test {
namespace {

enum { kCommandGroup, kParameterGroup, kRecordGroup };

extern "C" std::uint16_t answer_as_bus(const std::uint16_t* request, std::uint16_t count, std::uint16_t* answer) {
  return request_answer(GUARD_BUS, request, count, answer);
}

class Input {
 public:
  Input(const std::uint8_t* at, const std::uint8_t* end) : at_(at), end_(end) {}
  bool more() const { return at_ < end_; }
  std::uint8_t next() { return more() ? *at_++ : 0; }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

class BusPlayer {
 public:
  BusPlayer() {
    board = FakeBoard{};
    if (nvm.octets > 0) nvm = FakeNvm{};
    drive_reset();
    hil_reset();
    can_node_reset(answer_as_bus);
    drive.state = DRIVE_READY;
    rounds(1);
  }

  void play(Input in) {
    while (in.more()) {
      const int step = in.next() % 6;
      if (step <= kRecordGroup) {
        send(step, any_frame(in));
      } else if (step == 3) {
        pass(in.next());
      } else if (step == 4) {
        const std::uint8_t mode = in.next();
        const std::uint8_t speed = in.next();
        command(mode % 4, static_cast<std::int8_t>(speed) * 100, (in.next() & 1) != 0);
      } else {
        std::vector<std::uint16_t> record;
        for (int left = in.next() % 64; left > 0; --left) record.push_back(in.next());
        send_record(record);
      }
    }
  }

  /// Whatever came: the drive can be stopped, a parameter can be read and a record is answered.
  std::string judge() {
    pass(600);  // what was begun has been forgotten
    // With the host in the loop there is nothing to stop: the power stage cannot come on before the next reset.
    if (hil_is_active()) return board.gates_on ? "the gates are on with the host in the loop" : "";
    drive.state = DRIVE_RUN;
    drive.request = {};
    command(CAN_MODE_STOP, 0, false);
    pass(2);
    command(CAN_MODE_OFF, 0, false);
    pass(2);
    if (drive_is_energised()) return "the drive was not stopped";
    board.can_out.clear();
    hal_can_frame_t f = can_frame(CAN_PARAMETER_REQUEST, node());
    can_put(&f, CAN_PARAMETER_REQUEST_ID, 222);
    send(kParameterGroup, f);
    send_record({REQUEST_STATUS, 0x5A});
    pass(10);
    if (!heard(0x380, 1)) return "a parameter was not answered";
    if (!heard(0x480, 2)) return "a request for the status was not answered";
    for (std::uint16_t k = 0; k < parameter_count(); ++k) {
      const parameter_info_t& p = *parameter_info(k);
      const std::int32_t raw = parameter_get(p.id);
      if (raw < p.minimum || raw > p.maximum) return std::string(p.name) + " is out of its range";
    }
    return "";
  }

 private:
  static std::uint16_t node() { return static_cast<std::uint16_t>(parameters.can_node); }

  static hal_can_frame_t any_frame(Input& in) {
    hal_can_frame_t f = {};
    f.length = static_cast<std::uint16_t>(std::min(in.next() & 0x0F, 8));
    for (std::uint16_t k = 0; k < f.length; ++k) f.data[k] = in.next();
    return f;
  }

  void send(int group, hal_can_frame_t f) {
    static constexpr can_message_t messages[] = {CAN_COMMAND, CAN_PARAMETER_REQUEST, CAN_RECORD_REQUEST};
    f.id = can_frame(messages[group], node()).id;
    board.can_in[group].push_back(f);
    while (board.can_in[group].size() > 4) rounds(1);
  }

  void command(std::int32_t mode, std::int32_t speed, bool clear) {
    hal_can_frame_t f = can_frame(CAN_COMMAND, node());
    can_put(&f, CAN_COMMAND_MODE, mode);
    can_put(&f, CAN_COMMAND_SPEED, speed);
    can_put(&f, CAN_COMMAND_CLEAR_FAULT, clear ? 1 : 0);
    can_put(&f, CAN_COMMAND_ALIVE, alive_ = (alive_ + 1) % 16);
    can_put(&f, CAN_COMMAND_CRC, can_crc8(&f, 3));
    send(kCommandGroup, f);
  }

  void send_record(const std::vector<std::uint16_t>& record) {
    segment_splitter_t s = {};
    std::copy(record.begin(), record.end(), s.octets);
    segment_split_begin(&s, static_cast<std::uint16_t>(record.size()), 0);
    hal_can_frame_t f = {};
    for (; segment_split_peek(&s, &f); segment_split_advance(&s, 0)) send(kRecordGroup, f);
  }

  static bool heard(std::uint32_t base, std::size_t least) {
    const auto is = [&](const hal_can_frame_t& f) { return f.id == base + node(); };
    return static_cast<std::size_t>(std::count_if(board.can_out.begin(), board.can_out.end(), is)) >= least;
  }

  // What the control interrupt would make of the requests.
  static void obey() {
    drive_request_t& r = drive.request;
    const bool energised = drive_is_energised();
    if (energised && (r.stop || r.coast)) drive.state = DRIVE_READY;
    if (!energised && drive.state == DRIVE_READY && r.start) drive.state = DRIVE_RUN;
    if (drive.state == DRIVE_FAULT && r.reset) drive.state = DRIVE_READY;
    r = {};
  }

  void pass(int ms) { rounds(4 * ms); }
  void rounds(int count) {
    for (int k = 0; k < count; ++k) {
      if (++round_ % 4 == 0) {
        drive.time_ms++;
        drive.heartbeat++;
        obey();
      }
      can_node_service();
      if (board.can_out.size() > 200) board.can_out.clear();
    }
  }

  std::uint16_t alive_ = 0;
  int round_ = 0;
};

}  // namespace

std::string play_bus(const std::uint8_t* octets, std::size_t count) {
  BusPlayer player;
  player.play(Input(octets, octets + count));
  return player.judge();
}

}  // namespace stillspin::test

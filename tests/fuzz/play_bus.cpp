#include "tests/fuzz/play_bus.hpp"

#include <algorithm>
#include <vector>

#include "tests/firmware/fake_hal.hpp"
#include "tests/fuzz/fuzz_board.hpp"
#include "tests/fuzz/fuzz_drive.h"

extern "C" {
#include "firmware/can/command.h"
#include "firmware/can/messages.h"
#include "firmware/can/segments.h"
#include "firmware/link/requests.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {
namespace {

constexpr int kRounds = 4;              // of the background level in a step of time
constexpr int kFine = 4, kCoarse = 25;  // steps of 1 ms, then of 25 ms

enum { kCommandGroup, kParameterGroup, kRecordGroup };

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
    fuzz_power_on();
    fuzz_node_on();
    rounds();
  }

  void play(Input in) {
    while (in.more()) {
      const int kind = in.next() % 8;
      if (kind <= kRecordGroup) {
        send(kind, any_frame(in));
      } else if (kind == 3) {
        pass(in.next());
      } else if (kind == 4) {
        const std::uint8_t mode = in.next();
        const std::uint8_t speed = in.next();
        command(mode % 4, static_cast<std::int8_t>(speed) * 100, (in.next() & 1) != 0);
      } else if (kind == 6) {
        fuzz_put_into(in.next() % FUZZ_STATES);
      } else if (kind == 7) {
        disturb(in.next());
      } else {
        std::vector<std::uint16_t> record;
        for (int left = in.next() % 64; left > 0; --left) record.push_back(in.next());
        send_record(record);
      }
    }
  }

  /// Whatever came: the drive can be stopped, a parameter can be read and a record is answered.
  std::string judge() {
    board.can_status.state = HAL_CAN_ACTIVE;
    board.can_drains = true;
    pass(600);  // what was begun has been forgotten
    // With the host in the loop there is nothing to stop: the power stage cannot come on before the next reset.
    if (fuzz_has_host()) return board.gates_on ? "the gates are on with the host in the loop" : "";
    fuzz_forget_requests();
    if (runs_on_after(CAN_MODE_STOP)) return "the drive was not stopped";
    if (runs_on_after(CAN_MODE_OFF)) return "the drive was not switched off";
    board.can_out.clear();
    hal_can_frame_t f = can_frame(CAN_PARAMETER_REQUEST, fuzz_node());
    can_put(&f, CAN_PARAMETER_REQUEST_ID, 222);
    send(kParameterGroup, f);
    send_record({REQUEST_STATUS, 0x5A});
    pass(10);
    if (!heard(0x380, 1)) return "a parameter was not answered";
    if (!heard(0x480, 2)) return "a request for the status was not answered";
    return fuzz_complaint_of_parameters();
  }

 private:
  static hal_can_frame_t any_frame(Input& in) {
    hal_can_frame_t f = {};
    f.length = static_cast<std::uint16_t>(std::min(in.next() & 0x0F, 8));
    for (std::uint16_t k = 0; k < f.length; ++k) f.data[k] = in.next();
    return f;
  }

  void send(int group, hal_can_frame_t f) {
    static constexpr can_message_t messages[] = {CAN_COMMAND, CAN_PARAMETER_REQUEST, CAN_RECORD_REQUEST};
    f.id = can_frame(messages[group], fuzz_node()).id;
    board.can_in[group].push_back(f);
    if (board.can_in[group].size() > 4) rounds();
    if (board.can_in[group].size() > 12) board.can_in[group].pop_back();  // no mailbox is free
  }

  void command(std::int32_t mode, std::int32_t speed, bool clear) {
    hal_can_frame_t f = can_frame(CAN_COMMAND, fuzz_node());
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
    const auto is = [&](const hal_can_frame_t& f) { return f.id == base + fuzz_node(); };
    return static_cast<std::size_t>(std::count_if(board.can_out.begin(), board.can_out.end(), is)) >= least;
  }

  // The interrupt is held off until the command has been understood, so that nothing else can have stopped the drive.
  bool runs_on_after(can_mode_t mode) {
    fuzz_put_into(DRIVE_RUN);
    fuzz_background();
    // A drive that somebody else has started obeys a change of the mode; each mode twice, because the alive counter of
    // one of the four may be the last input's.
    for (const can_mode_t m : {CAN_MODE_RUN, CAN_MODE_RUN, mode, mode}) command(m, 0, false);
    rounds();
    if (!fuzz_is_running()) return true;
    fuzz_background();  // changed parameters come first
    fuzz_pass(1);
    return fuzz_is_running();
  }

  void disturb(std::uint8_t what) {
    board.can_status.state = static_cast<hal_can_state_t>(what % (HAL_CAN_BUS_OFF + 1));
    board.can_drains = (what & 0x10) == 0;
    fuzz_fault(what >> 5);
  }

  void pass(int ms) {
    for (int k = 0; ms > 0; ++k) {
      const int now = k < kFine ? 1 : std::min(ms, kCoarse);
      fuzz_pass(static_cast<std::uint16_t>(now));
      rounds();
      ms -= now;
    }
  }

  void rounds() {
    for (int k = 0; k < kRounds; ++k) {
      fuzz_serve_bus();
      if (board.can_out.size() > 200) board.can_out.clear();
    }
  }

  std::uint16_t alive_ = 0;
};

}  // namespace

std::string play_bus(const std::uint8_t* octets, std::size_t count) {
  BusPlayer player;
  player.play(Input(octets, octets + count));
  return player.judge();
}

}  // namespace stillspin::test

// The serial port round by round: how much is taken, what waits for room, what a reset forgets.

#include <algorithm>
#include <cmath>

#include "tests/firmware/requests.hpp"

extern "C" {
#include "firmware/console/output.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

constexpr int kLongest = RECORD_ENCODED_MAX + 2;  // that an answer can be on the wire

class LinkService : public Requests {
 protected:
  void SetUp() override {
    Requests::SetUp();
    board.serial_out.clear();
    board.serial_in.clear();
  }
  static std::size_t sent() { return board.serial_out.size(); }
};

// 115200 Bd are 1.15 octets in the 100 us after which a round comes at the latest. Of commands that are answered at
// once, and whose answers find room: they are longer than what asks for them.
TEST_F(LinkService, TextAtTheFullRateOfThePortDoesNotPileUp) {
  const std::string line = "ref 0\r";
  const std::size_t lines = 500;
  std::size_t most = 0, at = 0;
  for (double octets = 0; at < lines * line.size(); octets -= std::floor(octets)) {
    octets += 1.15;
    for (int k = 0; k < static_cast<int>(octets); ++k) send(line.substr(at++ % line.size(), 1));
    board.serial_room = HAL_SCI_TRANSMIT_RING;
    run(1);
    most = std::max(most, board.serial_in.size());
  }
  EXPECT_LE(most, 8u);
  run(10);
  std::size_t answers = 0;
  for (std::size_t from = 0; (from = text.find("ref 0.00 rpm", from)) != std::string::npos; ++from) ++answers;
  EXPECT_EQ(answers, lines) << "each is carried out";
}

TEST_F(LinkService, ARoundIsShortWhateverWaits) {
  send(std::string(200, 'x'));
  link_service();
  EXPECT_LT(board.serial_in.size(), 200u);
  EXPECT_GE(board.serial_in.size(), 192u);
  board.serial_in.clear();
  link_service();
  for (std::uint16_t k = 0; k < 3; ++k) send_record({REQUEST_STATUS, k});
  int answers = 0;
  for (int round = 0; round < 20; ++round) {
    const std::size_t before = sent();
    link_service();
    EXPECT_LE(sent() - before, 33u) << "one answer";
    answers += sent() - before > 20 ? 1 : 0;
  }
  EXPECT_EQ(answers, 3);
}

// An answer is whole or not at all: what cannot be answered is left in the port.
TEST_F(LinkService, ARequestWaitsForTheRoomThatAnAnswerMayNeed) {
  send_record({REQUEST_STATUS, 1});
  const std::size_t waiting = board.serial_in.size();
  board.serial_room = kLongest - 1;
  link_service();
  EXPECT_EQ(board.serial_in.size(), waiting);
  board.serial_room = kLongest;
  link_service();
  link_service();
  EXPECT_TRUE(board.serial_in.empty());
  EXPECT_GT(sent(), 20u);
}

TEST_F(LinkService, AnEventLeavesRoomForAnAnswerAndALine) {
  const std::uint16_t place = 9;
  const int event = 2 + 2 + 4 + 4 + 1 + 2 + 1;  // zeros, type and counter, time, value, known, CRC, COBS
  const int longest_event = event + 4 * (int(STREAM_SIGNALS) - 1);
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20().d = 0x01010101;
  stream_setup(COMM_WATCHDOG_SERIAL, 5, &place, 1);
  const auto sends_after = [&](unsigned ms, int missing) {
    const unsigned before = sent();
    inside::time_ms() += ms;
    board.serial_room = static_cast<std::uint16_t>(kLongest + TEXT_LINE_MAX + longest_event - missing);
    link_service();
    return sent() - before;
  };
  EXPECT_EQ(sends_after(5, 1), 0u) << "it waits";
  EXPECT_EQ(sends_after(4, 0), unsigned(event)) << "it comes late";
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_SERIAL), 0);
  EXPECT_EQ(sends_after(1, 1), 0u);
  EXPECT_EQ(sends_after(5, 0), unsigned(event)) << "the one that is due";
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_SERIAL), 1) << "the one before it";
  EXPECT_EQ(link_errors().events_dropped, 1);
}

// It comes all at once when the record that it might have been is given up.
TEST_F(LinkService, ACommandBehindAStrayZeroIsCarriedOut) {
  send(Octets{0});
  EXPECT_NE(command("get speed_limit").find("3300"), std::string::npos);
}

// Text was found behind a stray zero and not yet handed to the console.
TEST_F(LinkService, AResetForgetsTextThatWaits) {
  send(Octets{0} + Octets{'h', 'e', 'l', 'p', '\r'});
  link_service();
  inside::time_ms() += SPLITTER_REST_MS;
  link_service();
  link_reset();
  board.serial_out.clear();
  text.clear();
  run(500);
  EXPECT_EQ(text, "");
}

TEST_F(LinkService, AResetEndsWhatAMachineHasAskedFor) {
  EXPECT_EQ(ask(REQUEST_STREAM, little(5, 2) + little(4, 2)).status(), OK);
  comm_watchdog_begin(COMM_WATCHDOG_SERIAL, 7);
  send(Octets{0, 9, 9, 9, 0});
  run(10);
  EXPECT_EQ(link_errors().records.damaged, 1);
  link_reset();
  EXPECT_FALSE(comm_watchdog_is_on());
  EXPECT_EQ(link_errors().records.damaged, 0);
  records.clear();
  run(500);
  EXPECT_TRUE(records.empty());
}

}  // namespace

// The drive as a node of the bus: what it sends and when, parameters, records, recovery, arbitrary frames.

#include "tests/firmware/can_node.hpp"

#include <random>

extern "C" {
#include "firmware/api/actions.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/hil/hil.h"
#include "firmware/link/stream.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {
namespace {

TEST_F(CanNode, ListensToItsNumberAtItsRate) {
  parameters.can_node = 5;
  parameters.can_rate = 250;
  can_node_service();
  EXPECT_EQ(board.can_rate, 250'000u);
  ASSERT_EQ(board.can_groups.size(), 3u);
  EXPECT_EQ(board.can_groups[kCommandGroup].id, 0x105u);
  EXPECT_EQ(board.can_groups[kRecordGroup].id, 0x405u);
  EXPECT_EQ(board.can_groups[kCommandGroup].mask, 0x7FFu);
  parameters.can_node = 6;
  can_node_service();
  EXPECT_EQ(board.can_groups[kCommandGroup].id, 0x106u) << "a changed number takes effect at once";
  parameters.can_rate = 0;
  can_node_service();
  EXPECT_EQ(board.can_rate, 0u);
}

TEST_F(CanNode, SendsItsPeriodicMessagesInTime) {
  pass(1001);
  auto sent = take_sent();
  EXPECT_NEAR(double(sent[0x181].size()), 100, 1);
  EXPECT_NEAR(double(sent[0x201].size()), 50, 1);
  EXPECT_EQ(sent[0x201].size(), sent[0x281].size());
  EXPECT_EQ(sent[0x501].size(), 1u);
  for (std::size_t k = 1; k < sent[0x181].size(); ++k) {
    const auto step = can_get(&sent[0x181][k], CAN_STATUS_ALIVE) - can_get(&sent[0x181][k - 1], CAN_STATUS_ALIVE);
    ASSERT_EQ((step + 16) % 16, 1);
  }
  parameters.can_status_period = 0;
  parameters.can_telemetry_period = 100;
  pass(1000);
  sent = take_sent();
  EXPECT_EQ(sent.count(0x181), 0u);
  EXPECT_NEAR(double(sent[0x201].size()), 10, 1);
}

TEST_F(CanNode, StatusAndTelemetrySayWhatTheSignalsSay) {
  make_run();
  pass(20);
  board.can_out.clear();
  period();
  parameters.can_status_period = parameters.can_telemetry_period = 1;
  pass(3);
  auto sent = take_sent();
  const hal_can_frame_t status = sent[0x181].back();
  EXPECT_EQ(can_get(&status, CAN_STATUS_STATE), DRIVE_RUN);
  EXPECT_EQ(can_get(&status, CAN_STATUS_ENERGISED), 1);
  EXPECT_EQ(can_get(&status, CAN_STATUS_COMMANDED), 0);
  EXPECT_NEAR(can_get(&status, CAN_STATUS_REFERENCE) / 4.0, drive_signals().speed_reference / 65536.0, 2.0);
  const hal_can_frame_t telemetry = sent[0x201].back();
  EXPECT_NEAR(can_get(&telemetry, CAN_TELEMETRY_1_LINK_VOLTAGE) / 100.0, 300.0, 1.0);
}

TEST_F(CanNode, AMessageThatCannotLeaveIsLeftOutAndNotQueued) {
  pass(100);
  board.can_out.clear();
  board.can_drains = false;
  pass(500);
  for (const auto& [id, waiting] : take_sent())
    EXPECT_EQ(waiting.size(), 1u) << "in its mailbox, of " << std::hex << id;
}

TEST_F(CanNode, ParametersAreReadAndWrittenByNumber) {
  can_node_service();
  hal_can_frame_t r = answer_to(parameter(0, 222, 0));
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_STATUS), ANSWER_OK);
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_RAW), 200);
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_OPERATION), 0);
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_ID), 222);
  r = answer_to(parameter(1, 222, 300));
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_STATUS), ANSWER_OK);
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_RAW), 300);
  EXPECT_EQ(parameters.can_timeout, 300);
  r = answer_to(parameter(1, 222, -1));
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_STATUS), ANSWER_RANGE);
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_RAW), 300) << "what is in effect";
  r = answer_to(parameter(0, 9999, 0));
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_STATUS), ANSWER_UNKNOWN);
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_ID), 9999);
  r = answer_to(parameter(7, 222, 0));
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_STATUS), ANSWER_RANGE);
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_OPERATION), 7) << "as asked";
  inside::withdraw_reload();  // main.c's work
  make_run();
  r = answer_to(parameter(1, 220, 2));
  EXPECT_EQ(can_get(&r, CAN_PARAMETER_RESPONSE_STATUS), ANSWER_RUNNING);
}

TEST_F(CanNode, ARecordIsAnsweredInPieces) {
  std::vector<std::uint16_t> request(100);
  for (std::size_t k = 0; k < request.size(); ++k) request[k] = k & 0xFF;
  answer_octets = RECORD_MAX - 2;
  for (const auto& piece : pieces(request)) {
    board.can_in[kRecordGroup].push_back(piece);
    if (board.can_in[kRecordGroup].size() == 3) pass(1);
  }
  pass(5);
  EXPECT_EQ(last_request, request);
  segment_joiner_t joiner = {};
  bool whole = false;
  auto sent = take_sent();
  for (const auto& frame : sent[0x481]) whole = segment_join(&joiner, &frame, 0);
  EXPECT_TRUE(whole);
  EXPECT_EQ(joiner.count, answer_octets);
}

TEST_F(CanNode, TheNextRequestWaitsForTheAnswerBefore) {
  answer_octets = 100;
  for (int n = 0; n < 3; ++n) {
    for (const auto& piece : pieces({1, static_cast<std::uint16_t>(n)})) board.can_in[kRecordGroup].push_back(piece);
  }
  pass(10);
  segment_joiner_t joiner = {};
  int records = 0;
  auto sent = take_sent();
  for (const auto& frame : sent[0x481]) records += segment_join(&joiner, &frame, 0) ? 1 : 0;
  EXPECT_EQ(records, 3);
  EXPECT_EQ(joiner.dropped, 0u);
}

TEST_F(CanNode, AnAnswerThatNobodyTakesIsDropped) {
  answer_octets = 200;
  pass(5);
  board.can_out.clear();
  board.can_drains = false;
  board.can_room = 8;
  for (const auto& piece : pieces({1, 2})) board.can_in[kRecordGroup].push_back(piece);
  pass(SEGMENTS_REST_MS - 10);
  EXPECT_EQ(board.can_cancels, 0);
  pass(20);
  EXPECT_EQ(board.can_cancels, 1);
  auto left = take_sent();
  EXPECT_EQ(left.count(0x481), 0u);
  EXPECT_EQ(left.count(0x181), 1u) << "what else waits is not taken back";
  board.can_drains = true;
  board.can_out.clear();
  pass(5);
  EXPECT_EQ(take_sent().count(0x481), 0u) << "what is left of it does not follow later";
}

TEST_F(CanNode, BusOffIsLeftAfterAWhileAndAgain) {
  parameters.can_recovery = 100;
  pass(5);
  board.can_status.state = HAL_CAN_BUS_OFF;
  pass(99);
  EXPECT_EQ(board.can_recoveries, 0);
  pass(3);
  EXPECT_EQ(board.can_recoveries, 1);
  pass(100);
  EXPECT_EQ(board.can_recoveries, 2) << "still off: once more";
  board.can_status.state = HAL_CAN_ACTIVE;
  pass(500);
  EXPECT_EQ(board.can_recoveries, 2);
}

TEST_F(CanNode, DiagnosticTellsWhatWentWrong) {
  pass(5);
  board.can_status.lost = 3;
  board.can_status.bus_offs = 300;
  board.can_status.restarts = 7;
  board.can_status.transmit_errors = 40;
  board.can_status.receive_errors = 50;
  hal_can_frame_t bad = can_frame(CAN_COMMAND, 1);
  board.can_in[kCommandGroup].assign(4, bad);
  board.can_in[kCommandGroup].push_back(command(1));
  board.can_in[kCommandGroup].push_back(command(4));
  std::vector<hal_can_frame_t> record = pieces(std::vector<std::uint16_t>(30));
  record.erase(record.begin() + 1);
  board.can_in[kRecordGroup].assign(record.begin(), record.end());
  pass(1000);
  const hal_can_frame_t d = take_sent()[0x501].back();
  EXPECT_EQ(can_get(&d, CAN_DIAGNOSTIC_BAD_COMMANDS), 4);
  EXPECT_EQ(can_get(&d, CAN_DIAGNOSTIC_LOST_FRAMES), 3 + 2 + 1) << "overwritten, never come, in pieces";
  EXPECT_EQ(can_get(&d, CAN_DIAGNOSTIC_BUS_OFFS), 255);
  EXPECT_EQ(can_get(&d, CAN_DIAGNOSTIC_RESTARTS), 7);
  EXPECT_EQ(can_get(&d, CAN_DIAGNOSTIC_TRANSMIT_ERRORS), 40);
  EXPECT_EQ(can_get(&d, CAN_DIAGNOSTIC_RECEIVE_ERRORS), 50);
}

TEST_F(CanNode, WhatIsLostIsCountedToTheEndOfAWord) {
  board.can_status.lost = 65'535;
  EXPECT_EQ(can_node_state().lost, 65'535);
  board.can_status.lost = 65'000;
  EXPECT_EQ(can_node_state().lost, 65'000) << "and no sooner";
  board.can_status.lost = 65'535;
  board.can_in[kCommandGroup] = {command(1), command(4)};
  can_node_service();
  can_node_service();
  EXPECT_EQ(can_node_state().bad_commands, 0);
  EXPECT_EQ(can_node_state().lost, 65'535) << "with two commands that never came";
  board.can_status.lost = 3;
  EXPECT_EQ(can_node_state().lost, 5);
}

// The bus is heard all the same, so that nothing old waits when it is left.
TEST_F(CanNode, CommandsAreNotForTheDriveOfAHostInTheLoop) {
  can_node_service();
  ASSERT_EQ(hil_enter(), HIL_OK);
  board.can_in[kCommandGroup] = {command(1)};
  can_node_service();
  EXPECT_TRUE(board.can_in[kCommandGroup].empty());
  EXPECT_FALSE(can_node_state().heard);
  hil_reset();
  board.can_in[kCommandGroup] = {command(2)};
  can_node_service();
  EXPECT_TRUE(can_node_state().heard);
}

TEST_F(CanNode, WithNobodyToAnswerRecordsAreLeftUnanswered) {
  can_node_reset(nullptr);
  for (const auto& piece : pieces({1, 2, 3})) board.can_in[kRecordGroup].push_back(piece);
  pass(5);
  EXPECT_TRUE(board.can_in[kRecordGroup].empty());
  EXPECT_EQ(take_sent().count(0x481), 0u);
}

TEST_F(CanNode, IsOffTheBusUntilTheSavedRateIsKnown) {
  board.can_groups.clear();
  can_node_reset(answer_in_test);
  inside::loading() = true;
  pass(20);
  EXPECT_TRUE(board.can_groups.empty()) << "500 kbit/s may be the wrong rate";
  EXPECT_TRUE(board.can_out.empty());
  parameters.can_rate = 250;
  parameters.can_node = 7;
  inside::loading() = false;
  pass(20);
  EXPECT_EQ(board.can_rate, 250'000u);
  EXPECT_TRUE(take_sent().count(0x187) == 1);
}

TEST_F(CanNode, SendsTheStreamBehindTheAnswers) {
  parameters.can_status_period = parameters.can_telemetry_period = 0;
  const std::uint16_t speed_and_link[] = {2, 15};
  stream_setup(COMM_WATCHDOG_BUS, 20, speed_and_link, 2);
  pass(5);
  take_sent();
  segment_joiner_t joiner;
  segment_join_reset(&joiner);
  int events = 0;
  const auto hear = [&] {
    const std::vector<hal_can_frame_t> frames = take_sent()[0x481];
    for (const hal_can_frame_t& f : frames) {
      if (!segment_join(&joiner, &f, 0)) continue;
      ASSERT_EQ(joiner.count, 2 + 4 + 8 + 1);
      EXPECT_EQ(joiner.octets[0], EVENT_STREAM);
      events++;
    }
    EXPECT_EQ(joiner.octets[1] + 1, events + stream_lost(COMM_WATCHDOG_BUS)) << "none of them is lost silently";
  };
  pass(200);
  hear();
  EXPECT_EQ(events, 10);
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_BUS), 0);
  board.can_drains = false;  // unplugged
  board.can_room = 2;
  pass(2000);
  board.can_drains = true;
  pass(25);
  hear();
  EXPECT_GT(stream_lost(COMM_WATCHDOG_BUS), 90);
  stream_reset();
}

// Whatever came, the drive obeys the next proper commands.
TEST_F(CanNode, AnyFramesLeaveTheDriveControllable) {
  use_source(0);
  parameters.polarity_check = 0;
  use_parameters();
  pass(40);
  std::mt19937 random(11);
  for (int round = 0; round < 200'000; ++round) {
    hal_can_frame_t f = {};
    const std::uint32_t group = random() % 3;
    f.id = (group == 0 ? 0x101u : group == 1 ? 0x301u : 0x401u);
    f.length = static_cast<std::uint16_t>(random() % 9);
    for (auto& octet : f.data) octet = random() & 0xFF;
    if (group == kParameterGroup && f.data[0] == 1) f.data[0] = 0;  // not to write parameters at random
    board.can_in[group].push_back(f);
    period();
    can_node_service();
    if (board.can_out.size() > 100) board.can_out.clear();
  }
  for (auto& queue : board.can_in) queue.clear();
  std::uint16_t alive = 0;
  const auto say = [&](std::int32_t mode, int times) {
    for (int k = 0; k < times; ++k) {
      board.can_in[kCommandGroup].push_back(command(alive = (alive + 1) % 16, mode));
      pass(10);
    }
  };
  say(CAN_MODE_OFF, 10);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  say(CAN_MODE_RUN, 6);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  say(CAN_MODE_OFF, 2);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  answer_octets = 20;
  board.can_out.clear();
  for (const auto& piece : pieces({8, 1})) board.can_in[kRecordGroup].push_back(piece);
  pass(2);
  EXPECT_EQ(take_sent()[0x481].size(), 4u);
}

}  // namespace
}  // namespace stillspin::test

// How the node shares: the bus with other nodes, its mailboxes between messages, the background level's time, and the
// drive with a host in the loop.

#include <numeric>

#include "tests/firmware/can_node.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/hil/hil.h"
#include "firmware/link/stream.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {
namespace {

std::size_t mailboxes_to_send_with() {
  const auto add = [](std::size_t sum, const hal_can_group_t& group) { return sum + group.mailboxes; };
  const std::size_t taken = std::accumulate(board.can_groups.begin(), board.can_groups.end(), std::size_t{0}, add);
  return taken < HAL_CAN_MAILBOXES ? HAL_CAN_MAILBOXES - taken : 0;
}

// A fake bus that nobody acknowledges on: what is sent stays in its mailbox.
void unplug() {
  board.can_out.clear();
  board.can_drains = false;
  board.can_room = mailboxes_to_send_with();
}

/// Cycles that one round says it takes.
std::uint32_t cycles_of_a_round() {
  board.profile.clear();
  can_node_service();
  return spent();
}

TEST_F(CanNode, HearsWhatIsMeantForItAndNothingElse) {
  parameters.can_node = 9;
  can_node_service();
  const can_message_t heard[] = {CAN_COMMAND, CAN_PARAMETER_REQUEST, CAN_RECORD_REQUEST};
  ASSERT_EQ(board.can_groups.size(), std::size(heard));
  for (std::size_t k = 0; k < std::size(heard); ++k) {
    const hal_can_group_t& group = board.can_groups[k];
    EXPECT_EQ(group.id, can_frame(heard[k], 9).id);
    EXPECT_EQ(group.mask, 0x7FFu) << "no other node's";
    EXPECT_FALSE(group.extended);
    EXPECT_GE(group.mailboxes, 1);
  }
}

// A set-up takes the controller off the bus and forgets what waits in its mailboxes.
TEST_F(CanNode, IsSetUpAnewOnlyWhenTheRateOrTheNumberChanges) {
  pass(20);
  EXPECT_EQ(board.can_set_ups, 1);
  parameters.can_node = 2;
  pass(20);
  EXPECT_EQ(board.can_set_ups, 2);
  parameters.can_rate = 250;
  pass(20);
  EXPECT_EQ(board.can_set_ups, 3);
}

TEST_F(CanNode, WhatIsUrgentOvertakes) {
  board.can_in[kParameterGroup] = {parameter(0, 222, 0)};
  for (const auto& piece : pieces({1, 2})) board.can_in[kRecordGroup].push_back(piece);
  pass(1001);
  auto& priority = board.can_priority;
  for (const std::uint32_t id : {0x181u, 0x201u, 0x281u, 0x381u, 0x481u, 0x501u}) ASSERT_EQ(priority.count(id), 1u);
  EXPECT_GT(priority[0x181], priority[0x381]) << "the status before an answer";
  EXPECT_GT(priority[0x381], priority[0x201]) << "that before the telemetry";
  EXPECT_EQ(priority[0x201], priority[0x281]) << "of which the second part shall not come first";
  EXPECT_GT(priority[0x501], priority[0x481]) << "and records behind all";
  EXPECT_GT(priority[0x201], priority[0x481]);
}

TEST_F(CanNode, ALongRecordLeavesMailboxesForAllElse) {
  answer_octets = RECORD_MAX - 2;
  pass(5);
  unplug();
  for (const auto& piece : pieces({1, 2})) board.can_in[kRecordGroup].push_back(piece);
  board.can_in[kParameterGroup] = {parameter(0, 222, 0)};
  pass(100);
  auto waiting = take_sent();
  EXPECT_GE(waiting[0x481].size(), 1u);
  for (const std::uint32_t id : {0x181u, 0x201u, 0x281u, 0x381u}) EXPECT_EQ(waiting[id].size(), 1u) << std::hex << id;
}

TEST_F(CanNode, TheNextParameterWaitsForTheAnswerBefore) {
  pass(50);
  unplug();
  pass(50);  // other messages that wait do not matter
  board.can_in[kParameterGroup] = {parameter(0, 222, 0), parameter(0, 220, 0)};
  pass(50);
  EXPECT_EQ(board.can_in[kParameterGroup].size(), 1u);
  EXPECT_EQ(take_sent()[0x381].size(), 1u);
  board.can_drains = true;
  pass(1);
  EXPECT_TRUE(board.can_in[kParameterGroup].empty());
}

TEST_F(CanNode, AParameterRequestOfAnotherLengthIsNoRequest) {
  can_node_service();
  for (const std::uint16_t length : {0, 6, 8}) {
    hal_can_frame_t request = parameter(1, 222, 300);
    request.length = length;
    board.can_in[kParameterGroup] = {request};
    can_node_service();
    EXPECT_TRUE(board.can_in[kParameterGroup].empty());
    EXPECT_EQ(take_sent().count(0x381), 0u) << length;
    EXPECT_EQ(parameters.can_timeout, 200) << length;
  }
}

TEST_F(CanNode, TheStreamDoesNotPileUp) {
  parameters.can_status_period = parameters.can_telemetry_period = 0;
  const std::uint16_t speed[] = {4};
  stream_setup(COMM_WATCHDOG_BUS, 20, speed, 1);
  pass(25);
  const std::size_t pieces_of_one = take_sent()[0x481].size();
  ASSERT_GE(pieces_of_one, 1u);
  unplug();
  pass(200);
  EXPECT_EQ(take_sent()[0x481].size(), pieces_of_one) << "one event waits, the others are lost and counted";
  stream_reset();
}

// ---- time

TEST_F(CanNode, EveryMessageTakesItsTime) {
  parameters.can_status_period = parameters.can_telemetry_period = 0;
  can_node_service();
  const std::uint32_t idle = cycles_of_a_round();
  EXPECT_GT(idle, 0u);
  board.can_in[kCommandGroup] = {command(1)};
  EXPECT_GT(cycles_of_a_round(), idle) << "a command";
  board.can_in[kParameterGroup] = {parameter(0, 222, 0)};
  EXPECT_GT(cycles_of_a_round(), idle) << "a parameter";
  answer_octets = 0;
  const auto record = pieces(std::vector<std::uint16_t>(8));
  board.can_in[kRecordGroup] = {record[0]};
  const std::uint32_t piece = cycles_of_a_round();
  EXPECT_GT(piece, idle) << "a piece of a record";
  answer_octets = 20;
  board.can_in[kRecordGroup] = {record[1]};
  EXPECT_GT(cycles_of_a_round(), piece) << "an answer's pieces";
  parameters.can_status_period = 1;
  inside::time_ms()++;
  const std::uint32_t status = cycles_of_a_round();
  EXPECT_GT(status, idle) << "a status";
  parameters.can_status_period = 0;
  parameters.can_telemetry_period = 1;
  inside::time_ms()++;
  EXPECT_EQ(cycles_of_a_round() - idle, 2 * (status - idle)) << "telemetry is two messages";
  parameters.can_telemetry_period = 0;
  inside::time_ms() += 1000;
  EXPECT_EQ(cycles_of_a_round(), status) << "a diagnostic is one";
}

TEST_F(CanNode, ARoundHandlesAFewFramesAndReturns) {
  parameters.can_status_period = parameters.can_telemetry_period = 0;
  can_node_service();
  answer_octets = RECORD_MAX - 2;
  const auto request = pieces(std::vector<std::uint16_t>(100));
  board.can_in[kRecordGroup].assign(request.begin(), request.end());
  int rounds = 0;
  for (; !board.can_in[kRecordGroup].empty() && rounds < 100; ++rounds) {
    const std::size_t waiting = board.can_in[kRecordGroup].size();
    can_node_service();
    EXPECT_LE(waiting - board.can_in[kRecordGroup].size(), request.size() / 3);
  }
  EXPECT_LT(rounds, static_cast<int>(request.size())) << "but several at once";
  std::size_t out = board.can_out.size();
  for (rounds = 0; rounds < 100; ++rounds) {
    can_node_service();
    EXPECT_LE(board.can_out.size() - out, 6u);
    out = board.can_out.size();
  }
  EXPECT_GE(out, (RECORD_MAX + SEGMENT_OCTETS - 1) / SEGMENT_OCTETS) << "all of the answer";
}

// The background level was long away, and meanwhile the bus has gone: the pause counts from when that is seen.
TEST_F(CanNode, BusOffIsKeptForItsWholePauseHoweverLateItIsSeen) {
  parameters.can_recovery = 100;
  pass(5);
  board.can_status.state = HAL_CAN_BUS_OFF;
  inside::time_ms() += 1000;
  can_node_service();
  EXPECT_EQ(board.can_recoveries, 0);
  inside::time_ms() += 99;
  can_node_service();
  EXPECT_EQ(board.can_recoveries, 0);
  inside::time_ms() += 1;
  can_node_service();
  EXPECT_EQ(board.can_recoveries, 1);
}

// ---- state

TEST_F(CanNode, ItsStateTellsWhoIsInCommand) {
  use_source(0);
  parameters.polarity_check = 0;
  use_parameters();
  EXPECT_EQ(can_node_state().rate_kbit, -1);
  parameters.can_rate = 250;
  pass(40);
  EXPECT_EQ(can_node_state().node, 1);
  EXPECT_EQ(can_node_state().rate_kbit, 250);
  EXPECT_FALSE(can_node_state().heard);
  board.can_in[kCommandGroup] = {command(1)};
  pass(5);
  EXPECT_TRUE(can_node_state().heard);
  EXPECT_FALSE(can_node_state().commanding);
  board.can_in[kCommandGroup] = {command(2, CAN_MODE_RUN)};
  pass(60);
  ASSERT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_TRUE(can_node_state().commanding);
  EXPECT_FALSE(can_node_state().timed_out);
  pass(parameters.can_timeout);
  EXPECT_TRUE(can_node_state().timed_out);
  board.can_status.state = HAL_CAN_PASSIVE;
  board.can_status.receive_errors = 130;
  EXPECT_EQ(can_node_state().bus.state, HAL_CAN_PASSIVE);
  EXPECT_EQ(can_node_state().bus.receive_errors, 130);
}

TEST_F(CanNode, AResetForgetsAllThatWas) {
  parameters.can_recovery = 100;
  parameters.can_telemetry_period = 0;
  pass(15);
  const hal_can_frame_t first_status = take_sent()[0x181].at(0);
  board.can_in[kCommandGroup] = {command(1), command(4), can_frame(CAN_COMMAND, 1)};
  pass(1);
  unplug();
  board.can_room = 0;  // an answer on its way, the next request behind it, another one begun
  answer_octets = 40;
  for (int n = 0; n < 2; ++n) {
    for (const auto& piece : pieces({1, 2})) board.can_in[kRecordGroup].push_back(piece);
  }
  pass(5);
  board.can_status.state = HAL_CAN_BUS_OFF;
  pass(90);
  last_request.clear();
  can_node_reset(answer_in_test);
  const can_node_state_t state = can_node_state();
  EXPECT_EQ(state.rate_kbit, -1);
  EXPECT_FALSE(state.heard);
  EXPECT_EQ(state.bad_commands, 0);
  EXPECT_EQ(state.lost, 0);
  board.can_drains = true;
  pass(15);
  auto sent = take_sent();
  EXPECT_EQ(board.can_recoveries, 0) << "the pause begins anew";
  EXPECT_TRUE(last_request.empty());
  EXPECT_EQ(sent.count(0x481), 0u);
  ASSERT_EQ(sent[0x181].size(), 1u) << "a period later, not at once";
  EXPECT_EQ(can_get(&sent[0x181][0], CAN_STATUS_ALIVE), can_get(&first_status, CAN_STATUS_ALIVE));
  pass(900);
  EXPECT_EQ(take_sent().count(0x501), 0u) << "a second has not passed";
}

// ---- a host in the loop

TEST_F(CanNode, OfAHostInTheLoopTheBusCarriesRecordsOnly) {
  can_node_service();
  board.can_in[kCommandGroup] = {command(1)};
  can_node_service();
  ASSERT_EQ(hil_enter(), HIL_OK);
  take_sent();
  parameters.can_node = 2;  // the simulation's
  for (const auto& piece : pieces({1, 2})) board.can_in[kRecordGroup].push_back(piece);
  for (int ms = 0; ms < 1100; ++ms) {
    inside::time_ms()++;
    can_node_service();
  }
  EXPECT_EQ(board.can_set_ups, 1);
  EXPECT_FALSE(can_node_state().timed_out) << "no command is missed";
  const auto sent = take_sent();
  EXPECT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent.count(0x481), 1u);
  hil_reset();
  can_node_service();
  EXPECT_EQ(board.can_set_ups, 2) << "the drive's own again";
}

}  // namespace
}  // namespace stillspin::test

// Fields in frames, the check sum, and the table itself.

#include <gtest/gtest.h>

#include <random>

extern "C" {
#include "firmware/can/messages.h"
}

namespace stillspin::test {
namespace {

std::uint64_t bits_of(const can_field_info_t& f) {
  return (f.bits == 64 ? ~std::uint64_t{0} : ((std::uint64_t{1} << f.bits) - 1)) << f.first;
}

TEST(CanMessages, FieldsLieInTheirMessageAndDoNotOverlap) {
  std::uint64_t used[CAN_MESSAGES] = {};
  for (std::uint16_t k = 0; k < CAN_FIELDS; ++k) {
    const can_field_info_t& f = *can_field_info(k);
    ASSERT_LE(f.first + f.bits, 8 * can_message_info(f.message)->octets) << k;
    EXPECT_EQ(used[f.message] & bits_of(f), 0u) << k;
    used[f.message] |= bits_of(f);
    EXPECT_GE(f.per_unit, 1u) << k;
  }
  EXPECT_EQ(can_field_info(CAN_FIELDS), nullptr);
  EXPECT_EQ(can_message_info(CAN_MESSAGES), nullptr);
}

TEST(CanMessages, NodesDoNotShareIdentifiers) {
  for (std::uint16_t k = 1; k < CAN_MESSAGES; ++k) {
    EXPECT_GE(can_message_info(k)->base, can_message_info(k - 1)->base + CAN_NODE_MAX + 1);
    EXPECT_LE(can_message_info(k)->base + CAN_NODE_MAX, 0x7FFu);
  }
}

TEST(CanMessages, AMessageBeginsEmptyAndInTheStandardFormat) {
  for (std::uint16_t k = 0; k < CAN_MESSAGES; ++k) {
    const hal_can_frame_t frame = can_frame(static_cast<can_message_t>(k), CAN_NODE_MAX);
    EXPECT_EQ(frame.id, can_message_info(k)->base + CAN_NODE_MAX);
    EXPECT_FALSE(frame.extended);
    EXPECT_EQ(frame.length, can_message_info(k)->octets);
    for (const std::uint16_t octet : frame.data) EXPECT_EQ(octet, 0);
  }
}

TEST(CanMessages, EveryFieldKeepsItsExtremesAndLeavesTheOthersAlone) {
  for (std::uint16_t k = 0; k < CAN_FIELDS; ++k) {
    const can_field_info_t& f = *can_field_info(k);
    const auto field = static_cast<can_field_t>(k);
    const std::int64_t least = f.is_signed ? -(std::int64_t{1} << (f.bits - 1)) : 0;
    const std::int64_t most = least + (std::int64_t{1} << f.bits) - 1;
    for (const std::uint16_t ground : {0x00, 0xFF}) {
      for (const std::int64_t value : {least, least + 1, std::int64_t{0}, std::int64_t{1}, most - 1, most}) {
        if (value < least || value > most) continue;
        hal_can_frame_t frame = can_frame(static_cast<can_message_t>(f.message), 1);
        for (auto& octet : frame.data) octet = ground;
        can_put(&frame, field, static_cast<std::int32_t>(value));
        EXPECT_EQ(can_get(&frame, field), static_cast<std::int32_t>(value)) << k;
        std::uint64_t raw = 0;
        for (unsigned n = 0; n < 8; ++n) raw |= std::uint64_t{frame.data[n]} << 8 * n;
        EXPECT_EQ(raw & ~bits_of(f), (ground != 0 ? ~std::uint64_t{0} : 0) & ~bits_of(f)) << k;
      }
    }
  }
}

TEST(CanMessages, WhatDoesNotFitIsClamped) {
  hal_can_frame_t frame = can_frame(CAN_STATUS, 1);
  can_put(&frame, CAN_STATUS_SPEED, 40'000);
  EXPECT_EQ(can_get(&frame, CAN_STATUS_SPEED), 32'767);
  can_put(&frame, CAN_STATUS_SPEED, -40'000);
  EXPECT_EQ(can_get(&frame, CAN_STATUS_SPEED), -32'768);
  can_put(&frame, CAN_STATUS_FAULT, 300);
  EXPECT_EQ(can_get(&frame, CAN_STATUS_FAULT), 255);
  can_put(&frame, CAN_STATUS_FAULT, -1);
  EXPECT_EQ(can_get(&frame, CAN_STATUS_FAULT), 0);
}

TEST(CanMessages, StepsOfAFieldAreRounded) {
  EXPECT_EQ(can_steps(CAN_STATUS_SPEED, 600 << 16, 16), 2400);
  EXPECT_EQ(can_steps(CAN_STATUS_SPEED, -(600 << 16), 16), -2400);
  EXPECT_EQ(can_steps(CAN_STATUS_SPEED, (1 << 16) / 8 - 1, 16), 0) << "below half a step of 0.25 rpm";
  EXPECT_EQ(can_steps(CAN_STATUS_SPEED, (1 << 16) / 8 + 1, 16), 1);
  EXPECT_EQ(can_steps(CAN_TELEMETRY_1_CURRENT_D, 14 << 20, 20), 14'000);
  EXPECT_EQ(can_steps(CAN_TELEMETRY_1_CURRENT_D, INT32_MAX, 20), 2'048'000) << "2048 A: no overflow on the way";
}

TEST(CanMessages, CheckSumIsTheStandardOne) {
  // "123456789" with the first two characters as the identifier, low octet first.
  hal_can_frame_t frame = {0x3231, false, 7, {'3', '4', '5', '6', '7', '8', '9'}};
  EXPECT_EQ(can_crc8(&frame, 7), 0x4B);
}

TEST(CanMessages, CheckSumFindsEverySingleAndDoubleError) {
  hal_can_frame_t frame = {0x101, false, 4, {0x12, 0x60, 0x09}};
  const std::uint16_t right = can_crc8(&frame, 3);
  for (int a = 0; a < 24; ++a) {
    for (int b = a; b < 24; ++b) {
      hal_can_frame_t bad = frame;
      bad.data[a / 8] ^= 1 << a % 8;
      if (b != a) bad.data[b / 8] ^= 1 << b % 8;
      EXPECT_NE(can_crc8(&bad, 3), right);
    }
  }
  frame.id = 0x102;
  EXPECT_NE(can_crc8(&frame, 3), right) << "a command for another node";
}

}  // namespace
}  // namespace stillspin::test

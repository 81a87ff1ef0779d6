// Frames as another node sends them: a command, and a record in its pieces.

#ifndef STILLSPIN_TESTS_FIRMWARE_CAN_FRAMES_HPP
#define STILLSPIN_TESTS_FIRMWARE_CAN_FRAMES_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

extern "C" {
#include "firmware/can/messages.h"
#include "firmware/can/segments.h"
}

namespace stillspin::test {

/// For node 1.
inline hal_can_frame_t command_frame(std::int32_t alive, std::int32_t mode, std::int32_t speed = 0,
                                     bool clear = false) {
  hal_can_frame_t f = can_frame(CAN_COMMAND, 1);
  can_put(&f, CAN_COMMAND_MODE, mode);
  can_put(&f, CAN_COMMAND_SPEED, speed);
  can_put(&f, CAN_COMMAND_CLEAR_FAULT, clear ? 1 : 0);
  can_put(&f, CAN_COMMAND_ALIVE, alive);
  can_put(&f, CAN_COMMAND_CRC, can_crc8(&f, 3));
  return f;
}

/// Each of them with the head of `frame`.
inline std::vector<hal_can_frame_t> pieces_of(const std::vector<std::uint16_t>& record, hal_can_frame_t frame = {}) {
  segment_splitter_t s = {};
  std::copy(record.begin(), record.end(), s.octets);
  segment_split_begin(&s, static_cast<std::uint16_t>(record.size()), 0);
  std::vector<hal_can_frame_t> frames;
  for (; segment_split_peek(&s, &frame); segment_split_advance(&s, 0)) frames.push_back(frame);
  EXPECT_EQ(s.count, 0u);
  return frames;
}

}  // namespace stillspin::test

#endif

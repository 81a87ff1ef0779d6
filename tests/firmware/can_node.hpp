// What the tests of the bus node have in common: a drive on the bus, what it hears, and what it has sent.

#ifndef STILLSPIN_TESTS_FIRMWARE_CAN_NODE_HPP
#define STILLSPIN_TESTS_FIRMWARE_CAN_NODE_HPP

#include <algorithm>
#include <map>

#include "tests/firmware/can_frames.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/can/command.h"
#include "firmware/can/node.h"
}

namespace stillspin::test {

enum { kCommandGroup, kParameterGroup, kRecordGroup };

inline std::vector<std::uint16_t> last_request;
inline std::uint16_t answer_octets = 20;

extern "C" inline std::uint16_t answer_in_test(const std::uint16_t* request, std::uint16_t count, std::uint16_t* out) {
  last_request.assign(request, request + count);
  for (std::uint16_t k = 0; k < answer_octets; ++k) out[k] = (k * 3) & 0xFF;
  return answer_octets;
}

class CanNode : public Drive {
 protected:
  void SetUp() override {
    NEEDS("can");
    Drive::SetUp();
    last_request.clear();
    answer_octets = 20;
    can_node_reset(answer_in_test);
  }
  void pass(int ms) {
    for (int k = 0; k < ms; ++k) {
      for (int n = 0; n < 10; ++n) {
        period();
        forget_windows();
        can_node_service();
      }
    }
  }
  std::map<std::uint32_t, std::vector<hal_can_frame_t>> take_sent() {
    std::map<std::uint32_t, std::vector<hal_can_frame_t>> sent;
    for (const hal_can_frame_t& f : board.can_out) sent[f.id].push_back(f);
    board.can_out.clear();
    return sent;
  }
  static std::vector<hal_can_frame_t> pieces(const std::vector<std::uint16_t>& record) {
    return pieces_of(record, can_frame(CAN_RECORD_REQUEST, 1));
  }
  static hal_can_frame_t command(std::int32_t alive, std::int32_t mode = CAN_MODE_OFF) {
    return command_frame(alive, mode);
  }
  static hal_can_frame_t parameter(std::int32_t operation, std::int32_t id, std::int32_t raw) {
    hal_can_frame_t f = can_frame(CAN_PARAMETER_REQUEST, 1);
    can_put(&f, CAN_PARAMETER_REQUEST_OPERATION, operation);
    can_put(&f, CAN_PARAMETER_REQUEST_ID, id);
    can_put(&f, CAN_PARAMETER_REQUEST_RAW, raw);
    return f;
  }
  hal_can_frame_t answer_to(const hal_can_frame_t& request) {
    board.can_out.clear();
    board.can_in[kParameterGroup].push_back(request);
    can_node_service();
    auto all = take_sent();
    const auto& sent = all[0x381];
    EXPECT_EQ(sent.size(), 1u);
    return sent.empty() ? hal_can_frame_t{} : sent[0];
  }
};

}  // namespace stillspin::test

#endif

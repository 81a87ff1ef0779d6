// A virtual board that is asked over its serial port, to be stepped by the test.

#ifndef STILLSPIN_TESTS_BENCH_LOOP_HPP
#define STILLSPIN_TESTS_BENCH_LOOP_HPP

#include <gtest/gtest.h>

#include <memory>

#include "firmware/link/requests.h"
#include "sim_host/bench/board_port.hpp"
#include "sim_host/bench/virtual_board.hpp"

namespace stillspin::bench {

constexpr Tick kMillisecond = 100'000;
constexpr Tick kSecond = 1000 * kMillisecond;

class Loop : public ::testing::Test {
 protected:
  std::unique_ptr<VirtualBoard> desk;
  std::unique_ptr<Framing> serial = serial_framing();
  std::uint16_t tag = 0;

  void SetUp() override { switch_on(); }

  void switch_on() {
    BoardRequest request;
    request.setup.nominal = plant::PlantConfig();
    request.setup.solver = 1;  // fixed steps
    request.parameters = {{"can_rate", 1000.0}};
    desk = std::make_unique<VirtualBoard>(request);
    desk->advance(100 * kMillisecond);
  }

  // Status and body of the answer; empty when none comes within 50 ms.
  Words ask(Words type_and_body) {
    type_and_body.insert(type_and_body.begin() + 1, ++tag);
    desk->serial().send(serial->wrap(type_and_body), desk->now());
    for (int k = 0; k < 50; ++k) {
      desk->advance(kMillisecond);
      for (const std::uint8_t octet : desk->serial().take()) {
        if (!serial->take(octet)) continue;
        const Words record = serial->record();
        if (record[1] == (tag & 0xFFu)) return Words(record.begin() + 2, record.end());
      }
    }
    return {};
  }
  std::uint64_t resets() const { return desk->statistics().resets; }
};

}  // namespace stillspin::bench

#endif

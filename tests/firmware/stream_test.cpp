// Signals that come by themselves, at a period, to the port that has asked for them.

#include <set>

#include "tests/firmware/requests.hpp"

extern "C" {
#include "firmware/drive/signals.h"
#include "firmware/link/stream.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

TEST_F(Requests, AStreamComesAtItsPeriod) {
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20().d = 77;
  EXPECT_EQ(ask(REQUEST_STREAM, little(20, 2) + little(9, 2) + little(0, 2)).status(), OK);
  records.clear();
  run(2000);  // 200 ms
  ASSERT_EQ(records.size(), 10u);
  for (std::size_t k = 1; k < records.size(); ++k) {
    ASSERT_EQ(records[k].size(), 2u + 4u + 8u + 1u);
    EXPECT_EQ(records[k][0], EVENT_STREAM);
    EXPECT_EQ(records[k][1], records[k - 1][1] + 1);
    EXPECT_EQ(records[k][2], (records[k - 1][2] + 20) & 0xFF);
    EXPECT_EQ(records[k][6], 77);
  }
  EXPECT_EQ(ask(REQUEST_STREAM, little(0, 2)).status(), OK);
  records.clear();
  run(500);
  EXPECT_TRUE(records.empty());
}

// An answer may take the wire for most of a stream's period: a sample that is due meanwhile comes after it.
TEST_F(Requests, AStreamWaitsBehindAnAnswer) {
  EXPECT_EQ(ask(REQUEST_STREAM, little(25, 2) + little(4, 2)).status(), OK);
  for (int k = 0; k < 40; ++k) {
    const Answer long_one = ask(REQUEST_PARAMETER_READ, little(0, 2) + little(32, 1));
    ASSERT_EQ(long_one.status(), OK);
    ASSERT_GT(long_one.body(), 190u);
  }
  EXPECT_EQ(ask(REQUEST_LINK).number(14, 2), 0u);
}

TEST_F(Requests, AStreamWithoutRoomDropsAndCounts) {
  EXPECT_EQ(ask(REQUEST_STREAM, little(1, 2) + Octets(16, 0)).status(), OK);  // 45 octets a ms, 12 go through
  run(5000);
  const Answer a = ask(REQUEST_LINK);
  ASSERT_TRUE(a.came()) << "requests are answered beside it";
  EXPECT_GT(a.number(14, 2), 300u);
  std::set<int> steps;
  std::vector<int> counters;
  for (const Octets& r : records) {
    if (r[0] == EVENT_STREAM) counters.push_back(r[1]);
  }
  for (std::size_t k = 1; k < counters.size(); ++k) steps.insert((counters[k] - counters[k - 1]) & 0xFF);
  EXPECT_GT(*steps.rbegin(), 1) << "the gap can be seen";
  EXPECT_EQ(ask(REQUEST_STREAM, little(5, 2)).status(), LENGTH);
  EXPECT_EQ(ask(REQUEST_STREAM, little(5, 2) + little(signal_count(), 2)).status(), RANGE);
}

// Two clients, each on its port: neither ends nor slows the other's stream, nor gets its events.
TEST_F(Requests, EachPortHasItsStream) {
  std::uint16_t answer[RECORD_MAX], event[RECORD_MAX];
  const std::uint16_t request[] = {REQUEST_STREAM, 7, 10, 0, 4, 0};
  EXPECT_EQ(ask(REQUEST_STREAM, little(20, 2) + little(4, 2)).status(), OK);
  EXPECT_EQ(request_answer(COMM_WATCHDOG_BUS, request, 6, answer), 3);
  EXPECT_EQ(answer[2], OK);
  records.clear();
  int heard = 0;
  for (int ms = 0; ms < 200; ++ms) {
    run(10);
    if (stream_event(COMM_WATCHDOG_BUS, event) == 0) continue;
    EXPECT_EQ(event[1], heard++);
  }
  EXPECT_EQ(heard, 20);
  EXPECT_EQ(records.size(), 10u);
  EXPECT_EQ(ask(REQUEST_STREAM, little(0, 2)).status(), OK);
  run(10);
  EXPECT_GT(stream_event(COMM_WATCHDOG_BUS, event), 0) << "the other one goes on";
}

// The counter is used up by what was missed, so the host sees the gap; the rest stays in step.
TEST_F(Requests, AStreamKeepsItsStepOverWhatWasMissed) {
  const std::uint16_t places[] = {9, 10};
  std::uint16_t event[RECORD_MAX];
  const std::uint32_t begin = inside::time_ms();
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {-2, 0x01020304};
  stream_setup(COMM_WATCHDOG_BUS, 10, places, 2);
  const auto comes_at = [&](std::uint32_t ms) {
    inside::time_ms() = begin + ms;
    return stream_event(COMM_WATCHDOG_BUS, event) > 0;
  };
  EXPECT_FALSE(comes_at(9));
  ASSERT_TRUE(comes_at(10));
  EXPECT_EQ(Octets(event, event + 14),
            Octets({EVENT_STREAM, 0}) + little(begin + 10, 4) + little(0xFFFFFFFE, 4) + little(0x01020304, 4));
  EXPECT_FALSE(comes_at(19));
  ASSERT_TRUE(comes_at(57)) << "those of 30, 40 and 50 are missed";
  EXPECT_EQ(event[1], 4);
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_BUS), 3);
  EXPECT_FALSE(comes_at(59));
  ASSERT_TRUE(comes_at(60));
  EXPECT_EQ(event[1], 5);
  stream_dropped(COMM_WATCHDOG_BUS);
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_BUS), 4);
  stream_setup(COMM_WATCHDOG_BUS, 10, places, 1);
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_BUS), 0) << "a new one begins anew";
  EXPECT_FALSE(comes_at(69));
  ASSERT_TRUE(comes_at(70));
  EXPECT_EQ(event[1], 0);
  stream_reset();
  EXPECT_FALSE(comes_at(1000));
}

TEST_F(Requests, AStreamThatNobodyComesForIsCountedToTheEndOfAWord) {
  const std::uint16_t place = 0;
  std::uint16_t event[RECORD_MAX];
  stream_setup(COMM_WATCHDOG_BUS, 1, &place, 1);
  inside::time_ms() += 60'000;
  ASSERT_GT(stream_event(COMM_WATCHDOG_BUS, event), 0);
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_BUS), 59'999);
  inside::time_ms() += 60'000;
  ASSERT_GT(stream_event(COMM_WATCHDOG_BUS, event), 0);
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_BUS), 65'535);
  stream_dropped(COMM_WATCHDOG_BUS);
  EXPECT_EQ(stream_lost(COMM_WATCHDOG_BUS), 65'535);
}

}  // namespace

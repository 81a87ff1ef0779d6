// Steps of a drive whose host is in the loop: what they bring reaches the drive, and what they did is answered.

#include <gtest/gtest.h>

#include <random>

#include "tests/firmware/hil_host.hpp"

extern "C" {
#include "firmware/base/crc.h"
#include "firmware/commissioning/commissioning.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/signals.h"
#include "firmware/drive/steps.h"
#include "firmware/link/record.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;
using Words = HilPeriod::Words;

constexpr std::uint16_t kInTime = 1;  // what hal_pwm_write returns: the one thing that a drive at rest asks for
constexpr std::uint16_t kEarly = 8;   // a piece of work before the step

class Stepping : public Drive {
 protected:
  void SetUp() override {
    NEEDS("hil");
    Drive::SetUp();
    let_recordings_play();
    enter();
  }
  void TearDown() override { hil_reset(); }

  void enter() {
    ASSERT_EQ(hil_enter(), HIL_OK);
    host = HilHost();
  }

  static hil_result_t give(const HilHost::Octets& step, HilHost::Octets* answer) {
    answer->assign(RECORD_BODY_MAX, 0);
    octet_reader_t r = octet_reader(step.data(), static_cast<std::uint16_t>(step.size()));
    octet_writer_t w = octet_writer(answer->data(), RECORD_BODY_MAX);
    const hil_result_t result = hil_step(&r, &w);
    answer->resize(w.count);
    return result;
  }
  HilAnswer step(const HilPeriod& period) {
    HilHost::Octets answer;
    EXPECT_EQ(give(host.step(period), &answer), HIL_OK);
    return host.read(answer);
  }

  static replay_window_t recorded_window(std::uint16_t call, const hal_adc_window_t& w) {
    return {call, {w.start_a, w.start_b, w.end_a, w.end_b, w.link, w.aux}};
  }
  static HilPeriod empty() { return {{}, {kInTime}, {}}; }

  static void expect_in_recording(const HilPeriod& told) {
    const replay_period_t& p = hal_replay_period;
    EXPECT_EQ(Words(p.inputs, p.inputs + p.input_count), told.inputs);
    EXPECT_EQ(Words(p.works, p.works + p.work_count), told.works);
    ASSERT_EQ(p.window_count, told.windows.size());
    for (std::size_t k = 0; k < told.windows.size(); ++k) {
      EXPECT_EQ(p.windows[k].call, told.windows[k].call) << k;
      for (int n = 0; n < told.results; ++n) EXPECT_EQ(p.windows[k].results[n], told.windows[k].results[n]) << k;
    }
  }

  std::uint16_t any() { return static_cast<std::uint16_t>(random() >> (random() % 17 + 15)); }
  Words any_words(std::size_t most) {
    Words words(random() % (most + 1));
    for (auto& word : words) word = any();
    return words;
  }
  HilPeriod any_period() {
    HilPeriod p;
    p.inputs = any_words(REPLAY_INPUTS);
    p.works = any_words(REPLAY_WORKS);
    p.results = static_cast<std::uint16_t>(random() % (REPLAY_RESULTS + 1));
    p.windows.resize(random() % (REPLAY_WINDOWS + 1));
    for (replay_window_t& w : p.windows) {
      w.call = any();
      for (auto& word : w.results) word = any();
    }
    return p;
  }
  /// As much as there may be.
  HilPeriod fullest() {
    HilPeriod p = any_period();
    p.inputs.resize(REPLAY_INPUTS, 0x1234);
    p.works.resize(REPLAY_WORKS, 0x4321);
    p.windows.resize(REPLAY_WINDOWS);
    p.results = REPLAY_RESULTS;
    for (replay_window_t& w : p.windows) w = {any(), {any(), any(), any(), any(), any(), any()}};
    return p;
  }

  HilHost host;
  std::minstd_rand random{7};
};

// The purpose of it all: whoever steps a drive sees what the same drive does by itself, to the last bit.
TEST_F(Stepping, ADriveDoesWhatItDoesByItself) {
  struct Period {
    std::vector<hal_adc_window_t> windows;
    std::uint32_t crc;
    hal_pwm_frame_t frame;
  };
  std::vector<Period> recorded;
  hil_reset();
  drive_reset();
  for (int n = 0; n < 450; ++n) {
    Period p;
    for (int k = inside::sampled_pattern().window_count; k > 0; --k) {
      hal_adc_window_t w = still_window(300.0 + random() % 5);
      w.start_a = static_cast<std::uint16_t>(w.start_a + random() % 9);
      w.end_b = static_cast<std::uint16_t>(w.end_b + random() % 9);
      p.windows.push_back(w);
      board.adc.push_back(w);
      drive_window_interrupt();
    }
    drive_control_interrupt();
    p.crc = hil_signals_crc();
    p.frame = board.frame;
    recorded.push_back(p);
  }
  ASSERT_EQ(inside::state(), DRIVE_READY);
  enter();
  for (std::size_t n = 0; n < recorded.size(); ++n) {
    HilPeriod told = empty();
    for (const hal_adc_window_t& w : recorded[n].windows) told.windows.push_back(recorded_window(0, w));
    const HilAnswer a = step(told);
    const std::uint16_t* rise = recorded[n].frame.edge_tick;
    ASSERT_TRUE(a.fits);
    ASSERT_EQ(a.sequence, n);
    ASSERT_EQ(a.torn, 0) << n;
    ASSERT_EQ(a.crc, recorded[n].crc) << n;
    ASSERT_EQ(a.outputs, Words({REPLAY_FRAME, rise[0], rise[1], rise[2]})) << n;
  }
}

TEST_F(Stepping, WhatIsToldStandsInTheRecording) {
  for (int n = 0; n < 500; ++n) {
    const HilPeriod told = n % 10 == 0 ? fullest() : any_period();
    const HilAnswer a = step(told);
    ASSERT_NO_FATAL_FAILURE(expect_in_recording(told)) << n;
    ASSERT_TRUE(a.fits) << n;
    ASSERT_EQ(a.sequence, n);
    ASSERT_EQ(a.torn, hal_replay.torn ? 1 : 0) << n;
    ASSERT_EQ(a.outputs, Words(hal_replay_period.outputs, hal_replay_period.outputs + hal_replay_period.output_count));
    ASSERT_EQ(a.crc, hil_signals_crc());
    ASSERT_EQ(hil_expected(), n + 1);
  }
}

// What is not told is as it was, so a difference begins with zeros in every place after each entry.
TEST_F(Stepping, ALoopBeginsWithZerosWhateverWasBefore) {
  (void)step(fullest());
  (void)step(fullest());
  enter();
  EXPECT_EQ(hil_expected(), 0);
  HilPeriod told = {std::vector<replay_window_t>(REPLAY_WINDOWS), Words(REPLAY_INPUTS), Words(REPLAY_WORKS)};
  const HilAnswer a = step(told);
  EXPECT_TRUE(a.fits);
  EXPECT_EQ(a.torn, 1);
  EXPECT_EQ(a.outputs.size(), 4u);
  expect_in_recording(told);
}

TEST_F(Stepping, AStepThatIsNotWholeChangesNothing) {
  const HilPeriod first = fullest();
  (void)step(first);
  const HilPeriod second = fullest();
  const HilHost::Octets whole = host.step(second);
  const std::uint32_t crc = hil_signals_crc();
  HilHost::Octets answer;
  for (std::size_t cut = 2; cut < whole.size(); ++cut) {
    const HilHost::Octets begun(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut));
    ASSERT_EQ(give(begun, &answer), HIL_FORMAT) << cut;
  }
  HilHost::Octets longer = whole;
  longer.push_back(0);
  ASSERT_EQ(give(longer, &answer), HIL_FORMAT);
  EXPECT_TRUE(answer.empty());
  EXPECT_EQ(hil_expected(), 1);
  EXPECT_EQ(hil_signals_crc(), crc);
  expect_in_recording(first);
  EXPECT_EQ(give(whole, &answer), HIL_OK) << "it comes again, whole";
  EXPECT_TRUE(host.read(answer).fits);
  expect_in_recording(second);
}

// The background's work stands on the side of the step on which it was done, as often as it was done.
TEST_F(Stepping, WorkIsDoneOnItsSideOfTheStep) {
  NEEDS("commissioning");
  for (const std::uint16_t side : {kEarly, std::uint16_t{0}}) {
    (void)step(empty());
    commissioning.evaluate = true;
    inside::request_reload();
    HilPeriod p = empty();
    p.works = {static_cast<std::uint16_t>(REPLAY_RELOADED | side), static_cast<std::uint16_t>(REPLAY_EVALUATED | side),
               static_cast<std::uint16_t>(REPLAY_RELOADED | side)};
    EXPECT_EQ(step(p).torn, 0) << side;
    EXPECT_FALSE(commissioning.evaluate || inside::reload_requested()) << "an evaluation changes parameters";
  }
  inside::request_reload();
  EXPECT_EQ(step(empty()).torn, 0);
  EXPECT_TRUE(inside::reload_requested()) << "none without a word in the recording";
}

// Windows are played where they came: before the step, in the call that hands the pulses over, behind it.
TEST_F(Stepping, WindowsComeWhereTheyCame) {
  const auto seen_by_steps = [&](const std::vector<std::uint16_t>& calls) {
    (void)step(empty());
    (void)step(empty());
    HilPeriod p = empty();
    for (const std::uint16_t call : calls) p.windows.push_back(recorded_window(call, still_window()));
    EXPECT_EQ(step(p).torn, 0);
    const bool in_this = inside::missing_windows() == 0;
    EXPECT_EQ(step(empty()).torn, 0);
    return std::make_pair(in_this, inside::missing_windows() == 0);
  };
  (void)step(empty());
  (void)step(empty());
  ASSERT_EQ(inside::sampled_pattern().window_count, 2) << "as many make a period whole";
  EXPECT_EQ(seen_by_steps({0, 0}), std::make_pair(true, false));
  EXPECT_EQ(seen_by_steps({1, REPLAY_BEHIND}), std::make_pair(false, true));
  EXPECT_EQ(seen_by_steps({0, REPLAY_BEHIND}), std::make_pair(false, false));
}

// A host with another compiler has to find the same number.
TEST_F(Stepping, TheCheckSumIsOverEverySignalInItsOrder) {
  inside::be_in(DRIVE_READY);
  inside::current_dq_q20() = {-1, 0x12345678};
  inside::command_dq_q16() = {INT32_MIN, 77};
  inside::low_speed_estimate().angle_bam = 0x89ABCDEF;
  std::uint32_t crc = CRC32_BEGIN;
  for (std::uint16_t k = 0; k < signal_count(); ++k) {
    const auto value = static_cast<std::uint32_t>(inside::signal(k, drive_known(&drive)));
    for (int bit = 0; bit < 32; bit += 8) crc = crc32_add(crc, (value >> bit) & 0xFF);
  }
  EXPECT_EQ(hil_signals_crc(), crc32_end(crc));
}

}  // namespace

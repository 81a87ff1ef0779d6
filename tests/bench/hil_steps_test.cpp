// A run of the virtual drive, recorded and then stepped on a board period by period: every answer is the same to the
// last bit, whatever the drive was doing.

#include <string>

#include "firmware/api/actions.h"
#include "sim_host/bench/run.hpp"
#include "tests/bench/drive_runs.hpp"
#include "tests/bench/loop.hpp"

namespace stillspin::bench {
namespace {

class Steps : public Loop {
 protected:
  using Periods = std::vector<RecordedPeriod>;

  void SetUp() override {}  // one board at a time: first comes the run

  static Periods record(RunRequest request) {
    Periods periods;
    request.setup.solver = 1;
    request.parameters["polarity_check"] = 0.0;
    request.recording = [&](const RecordedPeriod& period) {
      periods.push_back(period);
      return true;
    };
    reason = run(request).reason;
    return periods;
  }
  Words asked(const Octets& request) { return ask(Words(request.begin(), request.end())); }
  static Words done(const Octets& answer) {
    Words words(answer.begin(), answer.end());
    words.insert(words.begin(), ANSWER_OK);
    return words;
  }
  // Status and body of the answer to a period's step.
  Words play(const RecordedPeriod& period) {
    for (const Octets& request : period.requests) {
      const std::uint16_t status = asked(request).front();
      EXPECT_TRUE(status == ANSWER_OK || status == ANSWER_CONFLICT) << "taken, be it for now without effect";
    }
    Octets step = period.step;
    step.insert(step.begin(), REQUEST_HIL_STEP);
    return asked(step);
  }
  void play(const Periods& periods) {
    switch_on();
    ASSERT_EQ(ask({REQUEST_HIL_ENTER}), Words{0});
    for (std::size_t k = 0; k < periods.size(); ++k) {
      ASSERT_EQ(play(periods[k]), done(periods[k].answer)) << "period " << k;
    }
  }
  static std::string reason;
};

std::string Steps::reason;

// From power-on over the start to rest again, with values that change on the way.
TEST_F(Steps, ADriveWithPulsesDoesTheSame) {
  RunRequest request = noisy_request(0.01, 3);
  request.commands = {{0.0, "speed_ref_rpm", 100.0}, {0.002, "set:speed_ramp", 900.0}, {0.005, "coast", 0.0}};
  const Periods periods = record(request);
  EXPECT_EQ(reason, "");
  play(periods);
  EXPECT_EQ(desk->statistics().resets, 0u);
}

TEST_F(Steps, ADriveWithSlicesDoesTheSame) {
  RunRequest request = noisy_request(0.005, 3);
  request.parameters["current_law"] = 1.0;
  request.commands = {{0.0, "speed_ref_rpm", 100.0}, {0.003, "coast", 0.0}};
  play(record(request));
}

// Behind the sequence of an answer stand its shape's changes: the first of them is that the recording is torn.
TEST_F(Steps, AnInputTooFewOrTooManyTearsTheRecording) {
  switch_on();
  const auto torn_by = [&](const Words& step) {
    EXPECT_EQ(ask({REQUEST_HIL_ENTER}), Words{0});
    return (ask(step).at(3) & 1) != 0;
  };
  EXPECT_TRUE(torn_by({REQUEST_HIL_STEP, 0, 0, 0})) << "an empty period";
  EXPECT_FALSE(torn_by({REQUEST_HIL_STEP, 0, 0, 0b0100, 1 << 1, 0})) << "the drive asks for one input";
  EXPECT_TRUE(torn_by({REQUEST_HIL_STEP, 0, 0, 0b0100, 2 << 1, 0}));
}

}  // namespace
}  // namespace stillspin::bench

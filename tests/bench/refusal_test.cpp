// What cannot be asked for is refused with the name, the value, the range and the unit, and leaves nothing behind.

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim_host/bench/setup.hpp"
#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

template <typename Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_words(const std::string& message, std::initializer_list<const char*> words) {
  EXPECT_FALSE(message.empty()) << "it was not refused";
  for (const char* word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' is not in: " << message;
  }
}

std::string refused_parameter(const std::string& name, double value) {
  RunRequest request = encoder_request(0.01);
  request.parameters[name] = value;
  return refusal([&] { (void)run(request); });
}

std::string refused_command(const std::string& what, double value) {
  RunRequest request = encoder_request(0.01);
  request.commands = {{0.0, what, value}};
  return refusal([&] { (void)run(request); });
}

TEST(Refusal, UnknownParameter) { expect_words(refused_parameter("curent_limit", 5.0), {"curent_limit"}); }

TEST(Refusal, ParameterOutOfRange) {
  expect_words(refused_parameter("current_limit", 140.0), {"current_limit", "140", "0.5", "100", "A"});
  expect_words(refused_parameter("current_limit", 0.0), {"current_limit"});
  expect_words(refused_parameter("current_limit", std::numeric_limits<double>::quiet_NaN()), {"current_limit"});
  expect_words(refused_parameter("current_limit", std::numeric_limits<double>::infinity()), {"current_limit"});
}

TEST(Refusal, LimitsOfAParameterThemselvesAreTaken) {
  for (const auto& [name, value] : {std::pair{"current_limit", 0.5}, {"current_full_scale", 200.0}}) {
    EXPECT_EQ(refused_parameter(name, value), "") << name;
  }
}

TEST(Refusal, UnknownCommand) { expect_words(refused_command("spin", 1.0), {"spin", "speed_ref_rpm"}); }

TEST(Refusal, CommandThatSetsAnUnknownParameter) { expect_words(refused_command("set:nothing", 1.0), {"nothing"}); }

TEST(Refusal, CommandThatSetsAParameterOutOfRange) {
  expect_words(refused_command("set:speed_ramp", 1e9), {"speed_ramp", "100000", "rpm/s"});
}

// It is known only when it happens; the run is then void and says why.
TEST(Refusal, ParameterThatMayNotChangeWhileRunning) {
  RunRequest request = encoder_request(0.05);
  request.commands = {{0.02, "set:pole_pairs", 3.0}};
  const RunResult result = run(request);
  EXPECT_FALSE(result.completed);
  EXPECT_FALSE(result.reason.empty());
}

TEST(Refusal, PlantEntries) {
  bench::Setup setup;
  expect_words(refusal([&] { set_entry(setup, "machine", "resistence", 1.0); }), {"machine.resistence"});
  expect_words(refusal([&] { set_entry(setup, "machin", "resistance", 1.0); }), {"machin.resistance"});
  expect_words(refusal([&] { set_entry(setup, "machine", "resistance", -1.0); }), {"machine.resistance", "-1", "ohm"});
}

TEST(Refusal, ImpossiblePlantIsRefusedBeforeItRuns) {
  RunRequest request = encoder_request(0.01);
  request.setup.nominal.sensor.count = 5;
  expect_words(refusal([&] { (void)run(request); }), {"sensor.count", "5"});
}

TEST(Refusal, DurationAndRecordEvery) {
  RunRequest request = encoder_request(0.0);
  expect_words(refusal([&] { (void)run(request); }), {"duration"});
  request = encoder_request(0.01);
  request.record_every = 0;
  expect_words(refusal([&] { (void)run(request); }), {"record_every"});
}

// Every entry that a setup offers has a default within its own range and can be set to it.
TEST(Refusal, EveryPlantEntryTakesItsDefault) {
  for (const Entry& entry : entries()) {
    bench::Setup setup;
    if (entry.kind == EntryKind::kText) {
      EXPECT_EQ(entry.text(setup), "") << entry.key;
      set_entry(setup, entry.section, entry.key, std::string("mine.csv"));
      EXPECT_EQ(entry.text(setup), "mine.csv") << entry.key;
      EXPECT_NE(refusal([&] { set_entry(setup, entry.section, entry.key, 1.0); }), "") << entry.key;
      continue;
    }
    const double value = entry.get(setup);
    EXPECT_EQ(refusal([&] { set_entry(setup, entry.section, entry.key, value); }), "")
        << entry.section << '.' << entry.key;
    EXPECT_EQ(entry.get(setup), value) << entry.section << '.' << entry.key;
  }
}

TEST(Refusal, SomethingRefusedLeavesTheDriveUsable) {
  (void)refused_parameter("nothing", 1.0);
  const RunResult result = run(encoder_request(0.01));
  EXPECT_TRUE(result.completed) << result.reason;
}

}  // namespace
}  // namespace stillspin::bench

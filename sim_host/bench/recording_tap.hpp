// What a run's hardware told the drive in every period, and what the drive made of it, as records for a board
// (firmware/hil/hil.h): the same periods can be stepped there and must give the same answers.

#ifndef STILLSPIN_SIM_HOST_BENCH_RECORDING_TAP_HPP
#define STILLSPIN_SIM_HOST_BENCH_RECORDING_TAP_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "firmware/hil/hil.h"
#include "hal/hal_replay.h"

namespace stillspin::bench {

using Octets = std::vector<std::uint8_t>;
using Words = std::vector<std::uint16_t>;

struct RecordedPeriod {
  std::vector<Octets> requests;       // type and body of what is asked of the drive before the step, in order
  Octets step;                        // body of the step's request
  Octets answer;                      // body of the answer that it must have
  Words outputs;                      // what the drive told its hardware, as the answer has it
  std::vector<std::int32_t> signals;  // raw, behind the step
};

/// Words of steps, as they last stood in their places.
struct StepWords {
  std::array<std::uint16_t, HIL_STEP_SHAPE> shape{};
  std::array<std::uint16_t, REPLAY_WORKS> works{};
  std::array<std::uint16_t, REPLAY_INPUTS> inputs{};
  std::array<std::array<std::uint16_t, HIL_WINDOW_WORDS>, REPLAY_WINDOWS> windows{};
};

/// Called behind every period from power-on; false ends the run.
using RecordingSink = std::function<bool(const RecordedPeriod&)>;

class RecordingTap {
 public:
  /// Without a sink everything here does nothing.
  explicit RecordingTap(RecordingSink sink);
  ~RecordingTap();
  RecordingTap(const RecordingTap&) = delete;
  RecordingTap& operator=(const RecordingTap&) = delete;

  /// At every period's start, before anything is asked of the drive in it. False when the sink wants no more.
  bool turn();

  void note_command(unsigned code, std::int32_t argument);
  void note_parameter(unsigned id, std::int32_t raw);

 private:
  static void take_late_period();
  void take_period();
  void ask(Octets request);
  bool hand_over();

  static RecordingTap* recording_;  // whose recording the firmware's is

  RecordingSink sink_;
  RecordedPeriod period_, next_;
  std::vector<RecordedPeriod> taken_;  // and not handed over yet
  std::uint16_t sequence_ = 0;
  StepWords step_before_;
  hil_answer_t answer_before_{};
  bool begun_ = false, torn_ = false;
};

}  // namespace stillspin::bench

#endif

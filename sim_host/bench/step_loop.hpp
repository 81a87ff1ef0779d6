// Host in the loop: what a run of the virtual drive does in every period is asked of a board, whose answer must be the
// same to the last bit. The loop is the taker of the run's recording; the first period that differs ends the run.

#ifndef STILLSPIN_SIM_HOST_BENCH_STEP_LOOP_HPP
#define STILLSPIN_SIM_HOST_BENCH_STEP_LOOP_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/bench/recording_tap.hpp"

namespace stillspin::bench {

/// A way to a board. Both calls may throw.
class Way {
 public:
  virtual ~Way() = default;
  /// Type and body of a request; its answer is received before the next one is sent.
  virtual void send(const Octets& request) = 0;
  /// Status and body of the answer, nothing at all to end the run.
  virtual Octets receive() = 0;
};

/// The first period in which a board did something else.
struct Mismatch {
  std::uint64_t step;  // from power-on
  bool torn;           // the board asked its hardware for something else
  Words board, native;
  std::vector<std::int32_t> signals;  // of the virtual drive
};

/// A request that the board refused: its status and its words.
struct Refusal {
  unsigned status;
  std::string words;
};

class StepLoop {
 public:
  explicit StepLoop(std::unique_ptr<Way> way);

  /// A period; false ends the run. The board computes it while the virtual drive computes the next one: its answer is
  /// looked at in the next call.
  bool take(const RecordedPeriod& period);

  /// Looks at the answer to the last period; needed behind every run.
  void finish();

  std::uint64_t steps() const { return steps_; }
  const std::optional<Mismatch>& mismatch() const { return mismatch_; }
  const std::optional<Refusal>& refusal() const { return refusal_; }
  /// Why the way to the board is lost, empty when it is not.
  const std::string& lost() const { return lost_; }

  /// What board and virtual drive have answered since the last call.
  std::pair<Octets, Octets> take_logs();

 private:
  bool ended() const { return mismatch_ || refusal_ || !lost_.empty() || stopped_; }
  void send(const RecordedPeriod& period);
  void receive();
  std::optional<Octets> accepted(const Octets& request);
  std::optional<Octets> accepted(std::uint8_t type, const Octets& answer);
  void compare(const Octets& board, const RecordedPeriod& period);
  bool read_outputs(const Octets& answer, Words& outputs, bool& torn);

  std::unique_ptr<Way> way_;
  std::optional<RecordedPeriod> sent_;  // the period whose answer has not been looked at
  std::uint64_t steps_ = 0;
  hil_answer_t before_{};  // of the board, to take the next one apart
  Octets board_log_, native_log_;
  std::optional<Mismatch> mismatch_;
  std::optional<Refusal> refusal_;
  std::string lost_;
  bool stopped_ = false;
};

}  // namespace stillspin::bench

#endif

#include "sim_host/bench/step_loop.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "firmware/actions.h"
#include "firmware/hil/delta.h"
#include "firmware/hil/hil.h"
#include "firmware/link/requests.h"

namespace stillspin::bench {

StepLoop::StepLoop(Ask ask) : ask_(std::move(ask)) {}

bool StepLoop::take(const TapedPeriod& period) {
  if (ended()) return false;  // the run goes on for some periods before it is broken off
  try {
    for (const Octets& request : period.requests) {
      if (!accepted(request)) return false;
    }
    Octets step(1 + period.step.size(), REQUEST_HIL_STEP);
    std::copy(period.step.begin(), period.step.end(), step.begin() + 1);
    if (const auto answer = accepted(step)) compare(*answer, period);
  } catch (const std::exception& error) {
    lost_ = error.what();
  }
  return !ended();
}

// The answer's body. With the power stage off a parameter is taken even if it does not go together with the others yet.
std::optional<Octets> StepLoop::accepted(const Octets& request) {
  const Octets answer = ask_(request);
  if (answer.empty()) {
    stopped_ = true;
    return std::nullopt;
  }
  const bool kept = request.front() == REQUEST_PARAMETER_SET && answer.front() == ANSWER_CONFLICT;
  if (answer.front() == ANSWER_OK || kept) return Octets(answer.begin() + 1, answer.end());
  refusal_ = Refusal{answer.front(), std::string(answer.begin() + 1, answer.end())};
  return std::nullopt;
}

void StepLoop::compare(const Octets& board, const TapedPeriod& period) {
  board_log_.insert(board_log_.end(), board.begin(), board.end());
  native_log_.insert(native_log_.end(), period.answer.begin(), period.answer.end());
  Words outputs;
  bool torn = false;
  const bool whole = read_outputs(board, outputs, torn);
  if (board != period.answer) mismatch_ = Mismatch{steps_, torn || !whole, outputs, period.outputs, period.signals};
  steps_++;
}

// False when it has another shape than an answer.
bool StepLoop::read_outputs(const Octets& answer, Words& outputs, bool& torn) {
  const Words octets(answer.begin(), answer.end());
  octet_reader_t r = octet_reader(octets.data(), static_cast<std::uint16_t>(octets.size()));
  (void)take_u16(&r);  // its number
  delta_take(&r, before_.shape, before_.shape, HIL_ANSWER_SHAPE);
  torn = before_.shape[0] != 0;
  const std::uint16_t count = before_.shape[1];
  if (count > TAPE_OUTPUTS) return false;
  delta_take(&r, before_.outputs, before_.outputs, count);
  (void)take_u32(&r);  // the check sum
  outputs.assign(before_.outputs, before_.outputs + count);
  return octets_fit(&r);
}

std::pair<Octets, Octets> StepLoop::take_logs() {
  return {std::exchange(board_log_, {}), std::exchange(native_log_, {})};
}

}  // namespace stillspin::bench

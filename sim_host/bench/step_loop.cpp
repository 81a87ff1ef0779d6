#include "sim_host/bench/step_loop.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "firmware/api/actions.h"
#include "firmware/hil/delta.h"
#include "firmware/hil/hil.h"
#include "firmware/link/requests.h"

namespace stillspin::bench {

StepLoop::StepLoop(std::unique_ptr<Way> way) : way_(std::move(way)) {}

bool StepLoop::take(const RecordedPeriod& period) {
  if (ended()) return false;  // the run goes on for some periods before it is broken off
  try {
    receive();
    if (!ended()) send(period);
  } catch (const std::exception& error) {
    lost_ = error.what();
  }
  return !ended();
}

void StepLoop::finish() {
  try {
    if (!ended()) receive();
  } catch (const std::exception& error) {
    lost_ = error.what();
  }
}

void StepLoop::send(const RecordedPeriod& period) {
  for (const Octets& request : period.requests) {
    if (!accepted(request)) return;
  }
  Octets step(1 + period.step.size(), REQUEST_HIL_STEP);
  std::copy(period.step.begin(), period.step.end(), step.begin() + 1);
  way_->send(step);
  sent_ = period;
}

void StepLoop::receive() {
  if (!sent_) return;
  const RecordedPeriod period = *std::exchange(sent_, std::nullopt);
  if (const auto answer = accepted(REQUEST_HIL_STEP, way_->receive())) compare(*answer, period);
}

std::optional<Octets> StepLoop::accepted(const Octets& request) {
  way_->send(request);
  return accepted(request.front(), way_->receive());
}

// The answer's body. With the power stage off a parameter is taken even if it does not go together with the others yet.
std::optional<Octets> StepLoop::accepted(std::uint8_t type, const Octets& answer) {
  if (answer.empty()) {
    stopped_ = true;
    return std::nullopt;
  }
  const bool kept = type == REQUEST_PARAMETER_SET && answer.front() == ANSWER_CONFLICT;
  if (answer.front() == ANSWER_OK || kept) return Octets(answer.begin() + 1, answer.end());
  refusal_ = Refusal{answer.front(), std::string(answer.begin() + 1, answer.end())};
  return std::nullopt;
}

void StepLoop::compare(const Octets& board, const RecordedPeriod& period) {
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
  if (count > REPLAY_OUTPUTS) return false;
  delta_take(&r, before_.outputs, before_.outputs, count);
  (void)take_u32(&r);  // the check sum
  outputs.assign(before_.outputs, before_.outputs + count);
  return octets_fit(&r);
}

std::pair<Octets, Octets> StepLoop::take_logs() {
  return {std::exchange(board_log_, {}), std::exchange(native_log_, {})};
}

}  // namespace stillspin::bench

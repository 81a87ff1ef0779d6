#include "sim_host/bench/tape_tap.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "firmware/drive_api.h"
#include "firmware/hil/hil.h"
#include "firmware/link/requests.h"
#include "hal/hal_tape.h"

namespace stillspin::bench {
namespace {

constexpr unsigned kWindowWords = 6;
constexpr unsigned kSliceWords = 3;

void put16(Octets& octets, unsigned value) {
  octets.push_back(static_cast<std::uint8_t>(value & 0xFFu));
  octets.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFFu));
}

void put32(Octets& octets, std::uint32_t value) {
  put16(octets, value & 0xFFFFu);
  put16(octets, value >> 16);
}

// The results of slices have three words; more of them than of windows come in a period.
unsigned words_of(const tape_period_t& p) {
  for (unsigned k = 0; k < p.window_count; k++) {
    const std::uint16_t* const r = p.windows[k].results;
    if (std::any_of(r + kSliceWords, r + kWindowWords, [](std::uint16_t word) { return word != 0; })) {
      return kWindowWords;
    }
  }
  return kSliceWords;
}

Octets step_of(const tape_period_t& p, std::uint16_t sequence) {
  const unsigned words = words_of(p);
  Octets step;
  put16(step, sequence);
  step.push_back(static_cast<std::uint8_t>(words));
  step.push_back(static_cast<std::uint8_t>(p.window_count));
  for (unsigned k = 0; k < p.window_count; k++) {
    put16(step, p.windows[k].call);
    for (unsigned n = 0; n < words; n++) put16(step, p.windows[k].results[n]);
  }
  step.push_back(static_cast<std::uint8_t>(p.input_count));
  for (unsigned k = 0; k < p.input_count; k++) put16(step, p.inputs[k]);
  return step;
}

Octets answer_of(const tape_period_t& p, std::uint16_t sequence) {
  Octets answer;
  put16(answer, sequence);
  answer.push_back(0);  // not torn
  answer.push_back(static_cast<std::uint8_t>(p.output_count));
  for (unsigned k = 0; k < p.output_count; k++) put16(answer, p.outputs[k]);
  put32(answer, hil_signals_crc());
  return answer;
}

Octets signals_now() {
  const drive_signals_t s = drive_signals();
  Octets octets;
#define SIGNAL(name, unit, q, value, meaning) put32(octets, static_cast<std::uint32_t>(s.name));
#include "firmware/signal_list.h"
#undef SIGNAL
  return octets;
}

}  // namespace

TapeTap::TapeTap(TapeSink sink) : sink_(std::move(sink)) {}

TapeTap::~TapeTap() {
  if (sink_) hal_tape_start(TAPE_OFF, nullptr);
}

bool TapeTap::turn() {
  if (!sink_) return true;
  // A step that has not run yet, or that is late and still running, belongs to the period that ends with it.
  if (begun_ && !hal_tape.stepped) return true;
  bool more = true;
  if (begun_) {
    if (!hal_tape_finish_period()) throw std::runtime_error("a period has more inputs or outputs than a tape holds");
    period_.step = step_of(hal_tape.period, sequence_);
    period_.answer = answer_of(hal_tape.period, sequence_);
    period_.signals = signals_now();
    more = sink_(period_);
    sequence_++;
    period_ = TapedPeriod();
  }
  // The firmware has come up by its first period, and has cleared the tape for itself.
  if (!begun_) hal_tape_start(TAPE_RECORDS, nullptr);
  begun_ = true;
  hal_tape_next_period();
  return more;
}

void TapeTap::note_command(unsigned code, std::int32_t argument) {
  if (!sink_) return;
  Octets request{REQUEST_COMMAND, static_cast<std::uint8_t>(code)};
  put32(request, static_cast<std::uint32_t>(argument));
  period_.requests.push_back(std::move(request));
}

void TapeTap::note_parameter(unsigned id, std::int32_t raw) {
  if (!sink_) return;
  Octets request{REQUEST_PARAMETER_SET};
  put16(request, id);
  put32(request, static_cast<std::uint32_t>(raw));
  period_.requests.push_back(std::move(request));
}

}  // namespace stillspin::bench

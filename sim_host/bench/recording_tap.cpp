#include "sim_host/bench/recording_tap.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "firmware/drive/signals.h"
#include "firmware/hil/delta.h"
#include "firmware/hil/hil.h"
#include "firmware/link/record.h"
#include "firmware/link/requests.h"
#include "firmware/mode/commands.h"
#include "hal/hal_replay.h"

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
unsigned words_of(const replay_period_t& p) {
  for (unsigned k = 0; k < p.window_count; k++) {
    const std::uint16_t* const r = p.windows[k].results;
    if (std::any_of(r + kSliceWords, r + kWindowWords, [](std::uint16_t word) { return word != 0; })) {
      return kWindowWords;
    }
  }
  return kSliceWords;
}

// What was written; a record has no room for more.
Octets octets_of(const octet_writer_t& w) {
  if (w.full) throw std::runtime_error("a period needs more octets than a record has");
  return Octets(w.octets, w.octets + w.count);
}

// Words against those that stood there, which they then are.
void put(octet_writer_t& w, const std::uint16_t* words, std::uint16_t* before, std::size_t count) {
  delta_put(&w, words, before, static_cast<std::uint16_t>(count));
  std::copy(words, words + count, before);
}

// In the order of firmware/hil/hil.h.
Octets step_of(const replay_period_t& p, std::uint16_t sequence, StepWords& before) {
  std::array<std::uint16_t, RECORD_BODY_MAX> room;
  octet_writer_t w = octet_writer(room.data(), RECORD_BODY_MAX);
  const unsigned results = words_of(p);
  const Words shape{p.window_count, static_cast<std::uint16_t>(results), p.input_count, p.work_count};
  put_u16(&w, sequence);
  put(w, shape.data(), before.shape.data(), shape.size());
  put(w, p.works, before.works.data(), p.work_count);
  put(w, p.inputs, before.inputs.data(), p.input_count);
  for (unsigned k = 0; k < p.window_count; k++) {
    Words window{p.windows[k].call};
    window.insert(window.end(), p.windows[k].results, p.windows[k].results + results);
    put(w, window.data(), before.windows[k].data(), window.size());
  }
  return octets_of(w);
}

Octets answer_of(const replay_period_t& p, std::uint16_t sequence, hil_answer_t& before) {
  std::array<std::uint16_t, RECORD_BODY_MAX> room;
  octet_writer_t w = octet_writer(room.data(), RECORD_BODY_MAX);
  hil_put_answer(&w, sequence, false, &p, &before);
  hil_keep_answer(&before, false, &p);
  return octets_of(w);
}

// The raw value of every signal of the drive, as it stands.
std::vector<std::int32_t> raw_signals() {
  const drive_signals_t s = drive_signals();
  return {
#define SIGNAL(name, unit, q, of, value, meaning) s.name,
#include "firmware/dictionary/all_signals.h"
#undef SIGNAL
  };
}

}  // namespace

RecordingTap* RecordingTap::recording_ = nullptr;

RecordingTap::RecordingTap(RecordingSink sink) : sink_(std::move(sink)) {}

RecordingTap::~RecordingTap() {
  if (!sink_) return;
  hal_replay_start(REPLAY_OFF, nullptr);
  recording_ = nullptr;
}

bool RecordingTap::turn() {
  if (!sink_) return true;
  // The firmware has come up by its first period, and has cleared the recording for itself.
  if (!begun_) {
    begun_ = true;
    recording_ = this;
    hal_replay_start(REPLAY_RECORDS, take_late_period);
  }
  // A step that has not run yet, or that is late and still running, belongs to the period that ends with it.
  // So does work of the background that this period's start came into.
  if (hal_replay_end_period()) take_period();
  return hand_over();
}

// Called by the drive before it does what belongs to the next period.
// Nothing may be thrown through it.
void RecordingTap::take_late_period() {
  try {
    recording_->take_period();
  } catch (const std::runtime_error&) {
    recording_->torn_ = true;
  }
}

void RecordingTap::take_period() {
  if (!hal_replay_finish_period()) torn_ = true;
  const replay_period_t& p = hal_replay_period;
  period_.step = step_of(p, sequence_, step_before_);
  period_.answer = answer_of(p, sequence_, answer_before_);
  period_.outputs.assign(p.outputs, p.outputs + p.output_count);
  period_.signals = raw_signals();
  taken_.push_back(std::exchange(period_, std::exchange(next_, {})));
  sequence_++;
  hal_replay_next_period();
}

bool RecordingTap::hand_over() {
  if (torn_) throw std::runtime_error("a period has more inputs or outputs than a recording holds");
  bool more = true;
  for (const RecordedPeriod& period : taken_) more = more && sink_(period);
  taken_.clear();
  return more;
}

void RecordingTap::note_command(unsigned code, std::int32_t argument) {
  if (!sink_) return;
  Octets request{REQUEST_COMMAND, static_cast<std::uint8_t>(code)};
  put32(request, static_cast<std::uint32_t>(argument));
  ask(std::move(request));
}

void RecordingTap::note_parameter(unsigned id, std::int32_t raw) {
  if (!sink_) return;
  Octets request{REQUEST_PARAMETER_SET};
  put16(request, id);
  put32(request, static_cast<std::uint32_t>(raw));
  ask(std::move(request));
}

// What is asked while a step runs, or is still in the recording, is for the one behind it.
void RecordingTap::ask(Octets request) {
  RecordedPeriod& period = hal_replay.stepping || hal_replay.stepped ? next_ : period_;
  period.requests.push_back(std::move(request));
}

}  // namespace stillspin::bench

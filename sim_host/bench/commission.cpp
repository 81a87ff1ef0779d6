#include "sim_host/bench/commission.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "firmware/boot/main.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/link/requests.h"
#include "firmware/mode/commands.h"
#include "sim_host/bench/board.hpp"
#include "sim_host/bench/firmware_lease.hpp"
#include "sim_host/bench/run.hpp"
#include "sim_host/bench/texts.hpp"

namespace stillspin::bench {
namespace {

constexpr double kSecondsPerTick = 1e-8;
constexpr Tick kChunk = 2'000'000;  // between looks at progress
constexpr Tick kEarliestStart = 5'000'000;

// Tells the drive its parameters, gives the command and waits for the outcome.
class Commissioner : public PeriodListener {
 public:
  explicit Commissioner(const CommissionRequest& request) : tap_(request.recording) {
    for (const auto& [name, value] : request.parameters) {
      unsigned id = 0;
      const std::int32_t raw = parameter_raw(name, value, Scale::of(request.parameters), id);
      parameters_.emplace_back(static_cast<std::uint16_t>(id), raw);
    }
  }

  void on_period(Tick t) override {
    taken_ = tap_.turn() && taken_;
    const drive_signals_t s = drive_signals();
    fault_ = fault_ == FAULT_NONE ? s.fault : fault_;
    if (s.state == DRIVE_READY && !configured_) {
      for (const auto& [id, raw] : parameters_) set(id, raw);
      configured_ = true;
    } else if (configured_ && !started_ && t >= kEarliestStart) {
      tap_.note_command(COMMAND_COMMISSION, 0);
      drive_command_commission();
      started_ = true;
      start_ = t;
    }
    const commissioning_outcome_t outcome = drive_commissioning_outcome();
    ended_ =
        started_ && outcome != COMMISSIONING_NONE && outcome != COMMISSIONING_RUNNING && s.state != DRIVE_COMMISSION;
    // A fault before the command keeps it from ever being taken.
    ended_ = ended_ || refused_ || (s.fault != FAULT_NONE && outcome != COMMISSIONING_RUNNING);
  }

  bool ended() const { return ended_; }
  bool refused() const { return refused_; }
  /// Whether the one who takes the recording wants more of it.
  bool taken() const { return taken_; }
  Tick start() const { return start_; }
  std::int32_t fault() const { return fault_; }

 private:
  void set(std::uint16_t id, std::int32_t raw) {
    tap_.note_parameter(id, raw);
    refused_ = parameter_set(id, raw) != SET_OK || refused_;
  }

  RecordingTap tap_;
  bool taken_ = true;
  std::vector<std::pair<std::uint16_t, std::int32_t>> parameters_;
  bool configured_ = false, started_ = false, ended_ = false, refused_ = false;
  Tick start_ = 0;
  std::int32_t fault_ = FAULT_NONE;
};

const parameter_info_t& info_of(std::uint16_t id) {
  for (std::uint16_t k = 0; k < parameter_count(); k++) {
    if (parameter_info(k)->id == id) return *parameter_info(k);
  }
  throw std::runtime_error("the drive reports a parameter that it does not have: " + std::to_string(id));
}

std::vector<Identified> identified() {
  std::vector<Identified> list;
  for (std::uint16_t k = 0; k < drive_commissioning_count(); k++) {
    const commissioning_result_t& r = *drive_commissioning_result(k);
    const parameter_info_t& info = info_of(r.id);
    Identified row;
    row.name = text_of(parameter_name(&info));
    row.unit = text_of(parameter_unit(&info));
    row.decimals = parameter_decimals(&info);
    row.before = std::ldexp(r.before, -static_cast<int>(parameter_q(&info)));
    row.value = std::ldexp(r.value, -static_cast<int>(parameter_q(&info)));
    row.used = r.verdict == VERDICT_USED;
    row.words = words_of(CATALOGUE_VERDICT, r.verdict);
    list.push_back(row);
  }
  return list;
}

std::string play(const CommissionRequest& request, chip::Chip& chip, const Commissioner& drive) {
  const Tick end = std::llround(request.limit / kSecondsPerTick);
  while (!drive.ended()) {
    if (chip.now() >= end) return "the commissioning took longer than " + std::to_string(request.limit) + " s";
    chip.run_until(std::min(chip.now() + kChunk, end));
    if (!drive.taken()) return "stopped by the one who takes the recording";
    if (chip.statistics().resets > 0) return "the watchdog reset the chip";
    const double share = drive_commissioning_progress() / 1000.0;
    const std::string phase = words_of(CATALOGUE_PHASE, drive_commissioning_phase());
    if (request.progress && !request.progress(share, phase)) return "stopped by the user";
  }
  if (drive.refused()) return "the drive refused a parameter";
  const commissioning_outcome_t outcome = drive_commissioning_outcome();
  if (outcome == COMMISSIONING_DONE || outcome == COMMISSIONING_PARTLY) return "";
  if (outcome == COMMISSIONING_ABORTED) return "the shaft was turning; it has been brought to rest, try again";
  return "fault: " + words_of(CATALOGUE_FAULT, static_cast<std::uint16_t>(drive.fault()));
}

}  // namespace

CommissionResult commission(const CommissionRequest& request) {
  if (!(request.limit > 0.0 && request.limit <= 3600.0))
    throw std::invalid_argument("limit must be above 0 and up to 3600 s");
  const FirmwareLease lease;
  CommissionResult result;
  Commissioner drive(request);
  Board board(request.setup.plant(), drive);
  board.equip(request.setup.board);
  chip::Chip chip(board, firmware_main);
  board.attach(chip);
  const auto begin = std::chrono::steady_clock::now();
  try {
    result.reason = play(request, chip, drive);
  } catch (const std::runtime_error& error) {
    result.reason = error.what();
  }
  result.completed = result.reason.empty();
  if (result.completed) result.values = identified();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.stats = {{"wall_seconds", wall},
                  {"simulated_seconds", chip.now() * kSecondsPerTick},
                  {"commissioning_seconds", (chip.now() - drive.start()) * kSecondsPerTick}};
  return result;
}

}  // namespace stillspin::bench

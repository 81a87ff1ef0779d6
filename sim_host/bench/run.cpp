#include "sim_host/bench/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "firmware/boot/main.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/link/requests.h"
#include "firmware/mode/commands.h"
#include "sim_host/bench/board.hpp"
#include "sim_host/bench/firmware_lease.hpp"
#include "sim_host/bench/recorder.hpp"
#include "sim_host/bench/texts.hpp"

namespace stillspin::bench {
namespace {

constexpr double kSecondsPerTick = 1e-8;
constexpr Tick kChunk = 1'000'000;          // between looks at progress
constexpr Tick kEarliestStart = 5'000'000;  // 50 ms after power-on

struct RawParameter {
  unsigned id;
  std::int32_t raw;
};

std::vector<RawParameter> raw_parameters(const std::map<std::string, double>& wanted) {
  const Scale scale = Scale::of(wanted);
  std::vector<RawParameter> list;
  for (const auto& [name, value] : wanted) {
    RawParameter p{};
    p.raw = parameter_raw(name, value, scale, p.id);
    list.push_back(p);
  }
  return list;
}

// How far the shaft turns during the start procedure, degrees mechanical.
class Travel {
 public:
  void from(double angle) { origin_ = angle; }
  void to(double angle) {
    last = (angle - origin_) * 180.0 / 3.14159265358979323846;
    forward = std::max(forward, last);
    backward = std::max(backward, -last);
  }
  double forward = 0.0, backward = 0.0, last = 0.0;

 private:
  double origin_ = 0.0;
};

// Follows the drive from period to period: gives the commands, keeps the record.
class Director : public PeriodListener {
 public:
  Director(const RunRequest& request, RunResult& result)
      : request_(request),
        result_(result),
        recorder_(request.record_every, request.setup.plant()),
        faults_(request.setup.fault),
        tap_(request.recording),
        parameters_(raw_parameters(request.parameters)) {
    recorder_.reserve(static_cast<std::size_t>(request.duration * 1e4 / request.record_every) + 2);
    for (const Command& c : request.commands) check(c, Scale::of(request.parameters));
  }

  void attach(Board& board) {
    board_ = &board;
    if (request_.setup.brake_until_run) board.plant().set_locked(true);
  }
  Tick origin() const { return origin_; }
  bool running() const { return origin_ >= 0; }
  bool broken() const { return !result_.reason.empty(); }
  std::vector<std::vector<double>> take_record() {
    return recorder_.take((running() ? origin_ : asked_) * kSecondsPerTick);
  }
  const Travel& travel() const { return travel_; }

  void on_period(Tick t) override {
    if (!tap_.turn() && result_.reason.empty()) result_.reason = "stopped by the one who takes the recording";
    const drive_signals_t s = drive_signals();
    recorder_.finish_row(s, drive.samples);
    watch_fault(t, s);
    board_->plant().advance(t);
    if (!running()) prepare(t, s);
    faults_.step(running() ? (t - origin_) * kSecondsPerTick : -1.0, t * kSecondsPerTick, *board_);
    if (running()) act(t);
    if (!started_) return;
    if (!running()) travel_.to(board_->plant().state().angle_m);
    if (running() || request_.record_start) recorder_.begin_row(t * kSecondsPerTick, board_->plant());
  }

 private:
  static void check(const Command& c, const Scale& scale) {
    unsigned id = 0;
    if (c.what.rfind("set:", 0) == 0) {
      (void)parameter_raw(c.what.substr(4), c.value, scale, id);
    } else if (c.what != "speed_ref_rpm" && c.what != "start" && c.what != "stop" && c.what != "coast" &&
               c.what != "reset") {
      throw std::invalid_argument("there is no command '" + c.what +
                                  "': speed_ref_rpm, start, stop, coast, reset or set:<parameter>");
    }
  }

  void watch_fault(Tick t, const drive_signals_t& s) {
    if (s.fault == last_fault_) return;
    last_fault_ = s.fault;
    if (s.fault == FAULT_NONE) return;
    const double at = (t - (running() ? origin_ : 0)) * kSecondsPerTick;
    result_.faults.emplace_back(at, words_of(CATALOGUE_FAULT, static_cast<std::uint16_t>(s.fault)));
    if (!running())
      result_.reason = "fault during the start: " + words_of(CATALOGUE_FAULT, static_cast<std::uint16_t>(s.fault));
  }

  void prepare(Tick t, const drive_signals_t& s) {
    if (!configured_ && s.state == DRIVE_READY) {
      for (const RawParameter& p : parameters_) set(p);
      configured_ = true;
    } else if (configured_ && !started_ && t >= kEarliestStart) {
      give_first_reference();
      give({0.0, "start", 0.0});
      started_ = true;
      asked_ = t;
      travel_.from(board_->plant().state().angle_m);
    } else if (started_ && s.state == DRIVE_RUN) {
      begin(t);
    }
  }

  void set(const RawParameter& p) {
    tap_.note_parameter(p.id, p.raw);
    const parameter_result_t r = parameter_set(static_cast<std::uint16_t>(p.id), p.raw);
    if (r != SET_OK) result_.reason = "the drive refused parameter " + std::to_string(p.id);
  }

  void begin(Tick t) {
    origin_ = t;
    std::vector<plant::LoadPoint> points;
    for (const auto& [time, torque] : request_.load)
      points.push_back({t + std::llround(time / kSecondsPerTick), torque});
    board_->plant().set_load(points);
    const WaveformRequest& w = request_.waveform;
    board_->probe().arm(t, t + periods(w.begin), t + periods(w.end), w.raster);
    if (request_.setup.brake_until_run) board_->plant().set_locked(request_.setup.nominal.mechanics.locked);
  }

  static Tick periods(double seconds) { return std::llround(seconds / kSecondsPerTick / kPeriod) * kPeriod; }

  void act(Tick t) {
    const double now = (t - origin_) * kSecondsPerTick;
    give_commands(now);
    if (request_.on_period) request_.on_period(now);
  }

  // What the drive is to do first it is told with the start: an I-F start turns the way that the reference says.
  void give_first_reference() {
    if (request_.commands.empty()) return;
    const Command& first = request_.commands.front();
    if (first.time > 0.0 || first.what != "speed_ref_rpm") return;
    give(first);
    next_command_++;
  }

  void give_commands(double now) {
    while (next_command_ < request_.commands.size() && request_.commands[next_command_].time <= now + 1e-9) {
      give(request_.commands[next_command_++]);
    }
  }

  void give(const Command& c) {
    if (c.what == "speed_ref_rpm") {
      const auto rpm_q16 = static_cast<std::int32_t>(std::lround(c.value * 65536.0));
      tap_.note_command(COMMAND_SPEED, rpm_q16);
      drive_command_speed(rpm_q16);
    }
    if (c.what == "start") tell(COMMAND_START, drive_command_start);
    if (c.what == "stop") tell(COMMAND_STOP, drive_command_stop);
    if (c.what == "coast") tell(COMMAND_COAST, drive_command_coast);
    if (c.what == "reset") tell(COMMAND_RESET, drive_command_reset);
    if (c.what.rfind("set:", 0) == 0) {
      RawParameter p{};
      p.raw = parameter_raw(c.what.substr(4), c.value, Scale::of(request_.parameters), p.id);
      set(p);
    }
  }

  void tell(unsigned code, void (*command)()) {
    tap_.note_command(code, 0);
    command();
  }

  const RunRequest& request_;
  RunResult& result_;
  Recorder recorder_;
  FaultPlayer faults_;
  RecordingTap tap_;
  std::vector<RawParameter> parameters_;
  Board* board_ = nullptr;
  Tick origin_ = -1;
  Tick asked_ = 0;  // when the start was asked for
  Travel travel_;
  std::size_t next_command_ = 0;
  std::int32_t last_fault_ = FAULT_NONE;
  bool configured_ = false;
  bool started_ = false;
};

void check_request(const RunRequest& r) {
  if (!(r.duration > 0.0 && r.duration <= 3600.0))
    throw std::invalid_argument("duration must be above 0 and up to 3600 s");
  if (!(r.max_start > 0.0 && r.max_start <= 60.0))
    throw std::invalid_argument("max_start must be above 0 and up to 60 s");
  if (r.record_every < 1) throw std::invalid_argument("record_every must be at least 1");
  if (r.waveform.begin < 0.0 || r.waveform.raster < 1)
    throw std::invalid_argument("a waveform must not begin before 0 s, and its raster must be at least 1 tick");
}

// Runs to the end of the start procedure, then for the duration. False when the run broke off; a fault ends it.
bool play(const RunRequest& request, chip::Chip& chip, Director& director, RunResult& result) {
  const Tick latest_start = std::llround(request.max_start / kSecondsPerTick);
  const Tick length = std::llround(request.duration / kSecondsPerTick);
  for (;;) {
    const Tick end = director.running() ? director.origin() + length + kPeriod : latest_start;
    if (chip.now() >= end) break;
    chip.run_until(std::min(chip.now() + kChunk, end));
    if (chip.statistics().resets > 0) result.reason = "the watchdog reset the chip";
    if (director.running() && !result.faults.empty()) result.reason = "fault: " + result.faults.front().second;
    if (director.broken()) return false;
    const double done = director.running() ? double(chip.now() - director.origin()) / length : 0.0;
    if (request.progress && !request.progress(std::min(done, 1.0))) {
      result.reason = "stopped by the user";
      return false;
    }
  }
  if (!director.running())
    result.reason = "the start procedure took longer than " + std::to_string(request.max_start) + " s";
  return result.reason.empty();
}

}  // namespace

RunResult run(const RunRequest& request) {
  check_request(request);
  const FirmwareLease lease;
  RunResult result;
  Director director(request, result);
  Board board(request.setup.plant(), director);
  board.equip(request.setup.board);
  chip::Chip chip(board, firmware_main);
  board.attach(chip);
  director.attach(board);
  const auto begin = std::chrono::steady_clock::now();
  try {
    result.completed = play(request, chip, director, result);
  } catch (const std::runtime_error& error) {
    result.reason = error.what();
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (const auto short_circuit = board.plant().shoot_through()) {
    result.completed = false;
    result.reason = "both devices of leg " + std::to_string(short_circuit->leg) + " conducted at tick " +
                    std::to_string(short_circuit->tick);
  }
  result.values = director.take_record();
  result.waveform = board.probe().take();
  const chip::Statistics& s = chip.statistics();
  result.stats = {{"wall_seconds", wall},
                  {"simulated_seconds", chip.now() * kSecondsPerTick},
                  {"start_seconds", director.running() ? director.origin() * kSecondsPerTick : 0.0},
                  {"start_travel_forward", director.travel().forward},
                  {"start_travel_backward", director.travel().backward},
                  {"start_travel", director.travel().last},
                  {"register_accesses", double(s.reads + s.writes)},
                  {"interrupts", double(s.interrupts)},
                  {"lost_writes", double(s.protected_writes_lost + s.gated_accesses)},
                  {"unmodelled_accesses", double(s.unmodelled_accesses)},
                  {"resets", double(s.resets)},
                  {"trips", double(board.trips())},
                  {"plant_share", board.plant_share()}};
  return result;
}

}  // namespace stillspin::bench

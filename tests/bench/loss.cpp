#include "tests/bench/loss.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/bench/drive_runs.hpp"

extern "C" {
#include "firmware/drive.h"
}

namespace stillspin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRamp = 15000.0;  // rpm/s
constexpr double kSettle = 0.3;    // s at the speed before the cause
constexpr double kPeriodTime = 1e-4;

void kick(double degrees) {
  const auto turn =
      static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(std::ldexp(degrees / 360.0, 32))));
  drive_position_t& p = drive.position;
  p.avv.observer.angle_bam += turn;
  p.observer.angle_bam += turn;
  p.zvv.angle_bam += turn;
  p.encoder.angle_bam += turn;
  p.encoder_offset_bam += turn;
}

double wrapped(double angle) { return std::remainder(angle, 2.0 * kPi); }

double cause_time(const LossCase& c) { return std::fabs(c.rpm) / kRamp + kSettle; }

void act(const LossCase& c, double at, RunRequest& r) {
  FaultPlan& f = r.setup.fault;
  switch (c.cause) {
    case Cause::kNone:
    case Cause::kKick:
      break;
    case Cause::kLoadStep:
      r.load.emplace_back(at, c.torque);
      r.load.emplace_back(at + 1e-3, c.value);
      break;
    case Cause::kSensorStuck:
      f.stuck_sensor = 1;
      f.stuck_sensor_at = at;
      f.stuck_sensor_value = c.value;
      break;
    case Cause::kSensorDrift:
      f.drift_sensor = 1;
      f.drift_sensor_at = at;
      f.drift_sensor_rate = c.value;
      break;
    case Cause::kOpenPhase:
      f.open_phase = c.value;
      f.open_phase_at = at;
      break;
  }
}

RunRequest request_of(const LossCase& c, double at) {
  RunRequest r;
  r.setup.nominal = c.bench ? plant::PlantConfig() : plant::PlantConfig::ideal();
  r.setup.solver = 1;
  r.parameters = {{"position_source", c.source}, {"speed_ramp", kRamp}};
  if (!c.bench)
    r.parameters.insert({{"dead_time", 0.0},
                         {"turn_on_delay", 0.0},
                         {"turn_off_delay", 0.0},
                         {"device_drop", 0.0},
                         {"device_resistance", 0.0}});
  r.commands = {{0.0, "speed_ref_rpm", c.rpm}};
  r.load = {{0.0, 0.0}, {0.1, c.torque}};
  r.duration = at + c.watch;
  act(c, at, r);
  return r;
}

double limit_ratio() {
  const synchronism_t& s = drive.supervision.synchronism;
  if (s.limit_q16 == 0) return 0.0;
  return std::hypot(double(s.error_q16.d), double(s.error_q16.q)) / s.limit_q16;
}

}  // namespace

std::string words(const LossCase& c) {
  const char* const names[] = {"nothing", "kick", "load step", "sensor stuck", "sensor drift", "open phase"};
  char text[120];
  std::snprintf(text, sizeof text, "%-12s %7.1f  %6.0f rpm %5.1f Nm  source %d  %s", names[static_cast<int>(c.cause)],
                c.value, c.rpm, c.torque, c.source, c.bench ? "bench" : "ideal");
  return text;
}

Loss run_case(const LossCase& c) {
  Loss loss;
  const double at = cause_time(c);
  RunRequest request = request_of(c, at);
  bool kicked = false;
  request.on_period = [&](double now) {
    if (now < at - kPeriodTime / 2) {
      loss.worst_ratio = std::max(loss.worst_ratio, limit_ratio());
    } else if (!kicked) {
      kicked = true;
      if (c.cause == Cause::kKick) kick(c.value);
    }
  };
  const RunResult result = run(request);
  const auto& time = column(result, "time");
  const auto& truth = column(result, "true_angle");
  const auto& used = column(result, "est_angle");
  const double fault_time = result.faults.empty() ? 1e9 : result.faults.front().first;
  loss.ran = kicked && fault_time > at;
  double lost_time = -1.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (time[k] < at - kPeriodTime / 2 || time[k] > fault_time) continue;
    if (std::fabs(wrapped(truth[k] - used[k])) < kPi / 2) continue;
    if (lost_time < 0.0) lost_time = time[k];
    loss.lost_for += kPeriodTime;
  }
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (time[k] <= fault_time) loss.speed_at_fault = column(result, "true_speed")[k];
  }
  loss.lost = lost_time >= 0.0;
  if (loss.lost) loss.lost_after = lost_time - at;
  if (!result.faults.empty()) {
    loss.faulted_after = fault_time - (loss.lost ? lost_time : at);
    loss.fault = result.faults.front().second;
  } else if (!result.completed) {
    loss.fault = result.reason;
  }
  return loss;
}

namespace {

void add_causes(std::vector<LossCase>& list, double rpm, double torque, int source, bool bench) {
  const auto add = [&](Cause cause, double value) { list.push_back({cause, value, rpm, torque, source, bench, 0.25}); };
  const double against = rpm < 0.0 ? -1.0 : 1.0;
  add(Cause::kKick, 180.0);
  add(Cause::kKick, 120.0);
  add(Cause::kKick, -100.0);
  add(Cause::kLoadStep, against * 40.0);
  add(Cause::kLoadStep, -against * 40.0);
  add(Cause::kSensorStuck, 0.0);
  add(Cause::kSensorStuck, 8.0);
  add(Cause::kSensorDrift, 300.0);
  add(Cause::kOpenPhase, 1.0);
}

}  // namespace

std::vector<LossCase> loss_cases(bool fast) {
  std::vector<LossCase> list;
  if (fast) {
    for (const double rpm : {60.0, -1000.0, 3000.0}) add_causes(list, rpm, rpm < 0 ? -2.0 : 2.0, 2, true);
    return list;
  }
  for (const int source : {2, 0, 3, 4}) {
    for (const double rpm : {0.0, 60.0, -60.0, 300.0, -300.0, 1000.0, -1000.0, 3000.0, -3000.0}) {
      add_causes(list, rpm, rpm < 0 ? -2.0 : 2.0, source, true);
      if (std::fabs(rpm) < 100.0) add_causes(list, rpm, 0.0, source, true);
    }
  }
  return list;
}

}  // namespace stillspin::bench

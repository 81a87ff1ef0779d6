#include "tests/bench/loss.hpp"

#include <cstdio>

#include "tests/bench/drive_runs.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/sources/paper/paper.h"
}

namespace stillspin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRamp = 15000.0;  // rpm/s
constexpr double kSettle = 0.3;    // s at the speed before the cause
constexpr double kWatch = 0.25;    // s after it
constexpr double kHalfPeriod = 0.5e-4;

void kick(double degrees) {
  const auto turn = static_cast<std::uint32_t>(std::llround(std::ldexp(degrees / 360.0, 32)));
  drive_estimate_t& p = drive.estimate;
  p.avv.observer.angle_bam += turn;
  p.observer.angle_bam += turn;
  paper_zvv.angle_bam += turn;
  encoder.observer.angle_bam += turn;
  encoder.offset_bam += turn;
  drive.supervision.judged_bam += turn;  // no estimator jumps: that it has done so is not to give it away
}

double cause_time(const LossCase& c) { return std::fabs(c.rpm) / kRamp + kSettle; }

void add_cause(const LossCase& c, double at, RunRequest& r) {
  FaultPlan& f = r.setup.fault;
  switch (c.cause) {
    case Cause::kKick:
      break;  // from outside of the plant: see run_case
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
  r.setup.nominal = plant::PlantConfig();
  r.setup.nominal.adc.seed = static_cast<std::uint64_t>(c.seed);
  r.setup.solver = 1;
  r.parameters = {{"position_source", c.source}, {"speed_ramp", kRamp}};
  r.commands = {{0.0, "speed_ref_rpm", c.rpm}};
  r.load = {{0.0, 0.0}, {0.1, c.torque}};
  r.duration = at + kWatch;
  add_cause(c, at, r);
  return r;
}

// What the record says between the cause and the fault.
void judge(const RunResult& result, double at, double fault_time, Loss& loss) {
  const auto& time = column(result, "time");
  const auto& truth = column(result, "true_angle");
  const auto& used = column(result, "est_angle");
  double lost_time = at;
  for (std::size_t k = 0; k < time.size() && time[k] <= fault_time; ++k) {
    loss.end_rpm = column(result, "true_speed")[k];
    if (time[k] < at - kHalfPeriod) continue;
    if (std::fabs(std::remainder(truth[k] - used[k], 2.0 * kPi)) < kPi / 2) continue;
    if (!loss.lost) lost_time = time[k];
    loss.lost = true;
    loss.lost_for += 2.0 * kHalfPeriod;
  }
  loss.lost_after = lost_time - at;
  if (!result.faults.empty()) loss.faulted_after = fault_time - lost_time;
}

}  // namespace

std::string words(const LossCase& c) {
  const char* const names[] = {"kick", "load step", "sensor stuck", "sensor drift", "open phase"};
  const char* const units[] = {"deg", "Nm", "A", "A/s", ""};
  const int k = static_cast<int>(c.cause);
  char text[120];
  std::snprintf(text, sizeof text, "%s %g %s\t%.0f\t%g\t%d", names[k], c.value, units[k], c.rpm, c.torque, c.source);
  return text;
}

Loss run_case(const LossCase& c) {
  const double at = cause_time(c);
  RunRequest request = request_of(c, at);
  bool acted = false;
  request.on_period = [&](double now) {
    if (acted || now < at - kHalfPeriod) return;
    acted = true;
    if (c.cause == Cause::kKick) kick(c.value);
  };
  const RunResult result = run(request);
  const double fault_time = result.faults.empty() ? 1e9 : result.faults.front().first;
  Loss loss;
  loss.ran = acted && fault_time > at && (result.completed || !result.faults.empty());
  loss.end = result.faults.empty() ? result.reason : result.faults.front().second;
  judge(result, at, fault_time, loss);
  return loss;
}

namespace {

void add_causes(std::vector<LossCase>& list, double rpm, double torque, int source) {
  const auto add = [&](Cause cause, double value) { list.push_back({cause, value, rpm, torque, source, 1}); };
  add(Cause::kKick, 180.0);
  add(Cause::kKick, 120.0);
  add(Cause::kKick, -100.0);
  add(Cause::kLoadStep, 40.0);
  add(Cause::kLoadStep, -40.0);
  add(Cause::kSensorStuck, 0.0);
  add(Cause::kSensorStuck, 8.0);
  add(Cause::kSensorDrift, 300.0);
  add(Cause::kOpenPhase, 1.0);
}

}  // namespace

std::vector<LossCase> loss_cases(bool fast) {
  std::vector<LossCase> list;
  for (const int source : {POSITION_OBSERVER, POSITION_OBSERVER_AVV, POSITION_ENCODER, POSITION_AVV}) {
    if (fast && source != POSITION_OBSERVER) continue;
    for (const double rpm : {0.0, 60.0, -60.0, 300.0, -300.0, 1000.0, -1000.0, 3000.0, -3000.0}) {
      if (fast && rpm < 0.0) continue;
      add_causes(list, rpm, rpm < 0.0 ? -2.0 : 2.0, source);
      if (!fast && std::fabs(rpm) < 100.0) add_causes(list, rpm, 0.0, source);
    }
    // Where noise alone sets the shaft in motion one draw of it says little.
    for (int seed = fast ? 1 : 2; seed <= 5; ++seed) list.push_back({Cause::kKick, 180.0, 0.0, 0.0, source, seed});
  }
  return list;
}

}  // namespace stillspin::bench
